#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/app/load_scene.h"
#include "simulator/app/program.h"
#include "simulator/app/screen.h"
#include "simulator/cache/influence_file.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/operators/influence.h"

namespace faultsim {
namespace {

/// Numbers of the compartments named, ascending, each once. Throws InputError with all unknown
/// names.
std::vector<int> regions_named(const Scene& scene, const std::vector<std::string>& names) {
  const std::string known = joined(scene.pressure, ", ", &PressureHistory::region);
  std::vector<int> regions;
  for (int r = 0; r < static_cast<int>(scene.pressure.size()); ++r) {
    if (contains(names, scene.pressure[r].region)) regions.push_back(r);
  }
  std::vector<Problem> problems;
  for (const std::string& name : names) {
    const auto named = [&](int r) { return scene.pressure[r].region == name; };
    if (std::ranges::any_of(regions, named)) continue;
    problems.push_back(
        {"", 0, concat("--region ", name, ": the scene has no such compartment"),
         known.empty() ? "give it blocks with a pressure change" : "choose among " + known});
  }
  if (!problems.empty()) throw InputError("faultsim influence", problems);
  return regions;
}

/// The scene as its influences are: those of exact elastic operators. What is left out is told.
LoadedScene elastic_and_exact(LoadedScene loaded, RunContext& context) {
  if (loaded.scene.pressure.empty()) {
    throw InputError(loaded.document.source, "the scene has no compartment whose pressure changes",
                     "give it a block with a pressure change");
  }
  const bool is_surface = loaded.scene.numerics.surface.wanted();
  if (is_surface) context.note("influences of the exact operator at the scene's own parameters");
  if (loaded.plan.creep.active)
    context.note("influences on elastic rock: they do not include what creep relaxes afterwards");
  if (!is_surface && !loaded.plan.creep.active) return loaded;
  loaded.scene.numerics.surface = {};
  loaded.scene.numerics.creep = Switch::off;
  std::vector<Problem> problems;
  loaded.plan = make_plan(loaded.scene, problems);
  FAULTSIM_DEMAND(problems.empty(), problems.front().what);
  return loaded;
}

void report(const InfluenceArguments& arguments, const PreparedInfluence& made) {
  const InfluenceBlock& block = *made.block;
  const auto p = block.traction.view();
  const double bytes = 8.0 * static_cast<double>(p.size() + block.observed.size());
  if (arguments.scene.json) {
    nlohmann::json out = {{"file", arguments.output.string()},
                          {"operator", block.operator_fingerprint},
                          {"n_cells", p.cols()},
                          {"n_jump_unknowns", p.rows()},
                          {"n_observed", block.observed.rows()},
                          {"bytes", bytes},
                          {"from_cache", made.from_cache},
                          {"build_s", block.build_seconds},
                          {"predicted_build_s", nullptr},
                          {"predicted_bytes", nullptr},
                          {"predicted_memory_bytes", nullptr}};
    if (!made.from_cache) {
      out["predicted_build_s"] = made.predicted.seconds;
      out["predicted_bytes"] = made.predicted.bytes;
      out["predicted_memory_bytes"] = kProgramBytes + made.predicted.peak_bytes;
    }
    std::cout << json_text(std::move(out));
    return;
  }
  std::printf("%s: %ld cells, %ld jump unknowns, %ld observed components, %.3g MB\n",
              arguments.output.c_str(), static_cast<long>(p.cols()), static_cast<long>(p.rows()),
              static_cast<long>(block.observed.rows()), bytes / 1e6);
  if (made.from_cache) {
    std::printf("from the cache; it took %.3g s to build\n", block.build_seconds);
  } else {
    std::printf("built in %.3g s after the operator; predicted %.3g s, %.3g MB\n",
                block.build_seconds, made.predicted.seconds, made.predicted.bytes / 1e6);
  }
}

}  // namespace

ExitCode influence_command(const InfluenceArguments& arguments) {
  ScreenMonitor monitor(arguments.scene.json);
  RunContext context = context_of(arguments.op, monitor);
  LoadedScene as_given = load_scene(arguments.scene);
  require_writable_file("-o", arguments.output, FileKind::hdf5, input_files(as_given));
  const LoadedScene loaded = elastic_and_exact(std::move(as_given), context);
  const std::vector<int> regions = regions_named(loaded.scene, arguments.regions);
  const PreparedInfluence made = prepare_influence(SceneBulk(loaded.scene, loaded.plan), regions,
                                                   cache_policy(arguments.op), context);
  if (!made.remark.empty()) monitor.note(made.remark);
  monitor.clear();
  write_influence(*made.block, *made.op, arguments.output);
  report(arguments, made);
  return ExitCode::done;
}

void add_influence(Program& program) {
  auto [command, a] =
      program.add("influence", "what a pressure change in each reservoir cell does to the faults",
                  influence_command);
  add_scene(command, a.scene);
  command->add_option("-o,--output", a.output, "HDF5 file to write")->required();
  command
      ->add_option("--region", a.regions,
                   "a compartment whose cells are wanted; may be repeated (default: all)")
      ->allow_extra_args(false);
  add_operator(command, a.op);
  command->footer(
      "Examples:\n"
      "  faultsim influence my-field.json -o influence.h5\n"
      "  faultsim influence my-field.json --region west --region east -o both.h5 --json\n"
      "With Biot coefficient b and a pressure change per cell, traction^T (b dp) is the change of "
      "the\n"
      "locked effective traction on every fault node: see docs/commands.md, influence.");
}

}  // namespace faultsim
