#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/app/commands.h"
#include "simulator/app/load_scene.h"
#include "simulator/app/screen.h"
#include "simulator/operators/influence.h"
#include "simulator/output/influence_file.h"
#include "simulator/output/json_text.h"
#include "simulator/output/output_target.h"

namespace faultsim {
namespace {

/// Numbers of the compartments named, ascending, each once. Throws InputError with all unknown
/// names.
std::vector<int> regions_named(const Scene& scene, const std::vector<std::string>& names) {
  std::string known;
  std::vector<int> regions;
  for (int r = 0; r < static_cast<int>(scene.pressure.size()); ++r) {
    const std::string& region = scene.pressure[r].region;
    known += (known.empty() ? "" : ", ") + region;
    if (std::find(names.begin(), names.end(), region) != names.end()) regions.push_back(r);
  }
  std::vector<Problem> problems;
  for (const std::string& name : names) {
    const auto named = [&](int r) { return scene.pressure[r].region == name; };
    if (std::any_of(regions.begin(), regions.end(), named)) continue;
    problems.push_back(
        {"", 0, concat("--region ", name, ": the scene has no such compartment"),
         known.empty() ? "give it blocks with a pressure change" : "choose among " + known});
  }
  if (!problems.empty()) throw InputError("faultsim influence", problems);
  return regions;
}

void refuse_what_has_no_block(const LoadedScene& loaded) {
  std::vector<Problem> problems;
  if (loaded.scene.numerics.surface.wanted()) {
    problems.push_back({"/numerics/surface", 0, "influences are those of an exact operator",
                        "remove the surface from the scene"});
  }
  if (loaded.plan.creep.active) {
    problems.push_back({"/numerics/creep", 0,
                        "influences are those of elastic rock, and this scene has creeping salt",
                        "take the elastic case: --set /numerics/creep=off"});
  }
  if (loaded.scene.pressure.empty()) {
    problems.push_back({"", 0, "the scene has no compartment whose pressure changes",
                        "give it a block with a pressure change"});
  }
  if (!problems.empty()) throw InputError(loaded.document.source, problems);
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
  const LoadedScene loaded = load_scene(arguments.scene);
  require_writable_file("-o", arguments.output, FileKind::hdf5, input_files(loaded));
  refuse_what_has_no_block(loaded);
  const std::vector<int> regions = regions_named(loaded.scene, arguments.regions);
  ScreenMonitor monitor(arguments.scene.json);
  const PreparedInfluence made =
      prepare_influence(loaded.scene, loaded.plan, regions, cache_policy(arguments.op),
                        context_of(arguments.op, monitor));
  if (!made.remark.empty()) monitor.note(made.remark);
  monitor.clear();
  write_influence(*made.block, *made.op, arguments.output);
  report(arguments, made);
  return ExitCode::done;
}

}  // namespace faultsim
