#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/app/commands.h"
#include "simulator/app/load_scene.h"
#include "simulator/app/screen.h"
#include "simulator/app/trace_text.h"
#include "simulator/common/machine.h"
#include "simulator/common/text.h"
#include "simulator/common/thread_team.h"
#include "simulator/coupled/start_hypre.h"
#include "simulator/coupled_case/coupled_case.h"
#include "simulator/coupled_case/path_choice.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/json_text.h"
#include "simulator/files/result_folder.h"
#include "simulator/linalg/blas.h"
#include "simulator/linalg/blas_kernel.h"
#include "simulator/loading/run_case.h"
#include "simulator/operators/cell_changes.h"
#include "simulator/result/result_json.h"
#include "simulator/result_files/field_writer.h"
#include "simulator/result_files/volume_writer.h"

namespace faultsim {
namespace {

std::string built_in(double seconds) { return formatted("operator: built in %.2f s", seconds); }

/// What the arguments ask for; automatic chooses by the plan. Throws InputError when the coupled
/// path is asked for and cannot take the scene.
PathChoice path_of(const RunArguments& arguments, const LoadedScene& loaded) {
  if (arguments.path == "condensed") return {SolutionPath::condensed, "asked for"};
  std::vector<Problem> hindrances = unsupported_by_coupled(loaded.scene, loaded.plan);
  if (arguments.path == "automatic") {
    return choose_path(loaded.plan, available_memory(), hindrances,
                       takes_columns(loaded.scene, loaded.plan));
  }
  if (!hindrances.empty()) throw InputError(arguments.scene.file, std::move(hindrances));
  return {SolutionPath::coupled, "asked for"};
}

std::string prepared_text(const FaultOperator& op, const std::optional<CaseSurface>& surface,
                          bool from_cache, bool coupled) {
  const std::string how =
      coupled      ? "no operator"
      : surface    ? concat("operator: interpolated between ", surface->n_operators, " exact ones")
      : from_cache ? "operator: from the cache"
                   : built_in(op.build_seconds);
  return concat(how, ", ", op.geometry.nodes.size(), " fault node pairs\n");
}

/// Pressures and temperatures in the cells, beside the displacements.
void add_cell_changes(const Scene& scene, const Mesh& mesh, bool half_domain,
                      std::vector<VolumeSnapshot>& volume) {
  const CellChanges changes(scene, mesh, half_domain);
  for (VolumeSnapshot& one : volume) {
    if (changes.has_pressure()) one.pressure_change = changes.pressure(one.time);
    if (changes.has_temperature()) one.temperature_change = changes.temperature(one.time);
  }
}

}  // namespace

ExitCode exit_code_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
    case Outcome::event:
    case Outcome::unresolved_event:
      return ExitCode::done;
    case Outcome::unconverged:
    case Outcome::unstable:
      return ExitCode::no_convergence;
    case Outcome::interrupted:
      return ExitCode::interrupted;
    case Outcome::failed:
      return ExitCode::bug;
  }
  return ExitCode::bug;
}

ExitCode run_command(const RunArguments& arguments) {
  const SolverChoice solver = solver_of(arguments.leading, arguments.schur);
  Simulation simulation = load_simulation(arguments.scene, arguments.op, arguments.exact);
  const LoadedScene& loaded = simulation.scene();
  simulation.check();
  Plan plan = loaded.plan;
  add_savings(loaded.scene, plan);
  const Scene& scene = loaded.scene;
  const PathChoice choice = path_of(arguments, loaded);
  const bool is_coupled = choice.path == SolutionPath::coupled;
  if (is_coupled) require_one_rank();
  const bool json = arguments.scene.json;
  if (const std::string complaint = blas_complaint(); !complaint.empty())
    std::cerr << complaint << "\n";
  const std::filesystem::path folder =
      arguments.output.empty()
          ? std::filesystem::path(std::filesystem::path(arguments.scene.file).stem().string() +
                                  "-result")
          : arguments.output;
  ResultFolder output({.option = "-o",
                       .folder = folder,
                       .made_by = "faultsim run",
                       .names = {"plan.json", "scene.json", "result.json", "faults.h5",
                                 "faults.xmf", "volume.h5", "volume.xmf", "trace.jsonl"},
                       .inputs = input_files(loaded)});
  nlohmann::json planned = plan_to_json(plan);
  planned["path"] = {{"name", to_string(choice.path)}, {"reason", choice.reason}};
  write_text(output.path() / "plan.json", json_text(planned));
  write_text(output.path() / "scene.json", loaded.document.value.dump(2) + "\n");

  ScreenMonitor monitor(json);
  if (!json) {
    std::cerr << plan_to_text(plan) << "linear algebra: " << blas_description() << " ("
              << blas_kernel_reason() << ")\n"
              << remarks_to_text(loaded);
    if (arguments.path != "condensed")
      std::cerr << "path: " << to_string(choice.path) << ", " << choice.reason << "\n";
  }
  RunContext context = context_of(arguments.op, monitor);
  ThreadTeam team(std::min(context.n_threads, kMostThreadsOfCase));
  context.team = &team;
  std::unique_ptr<CoupledCase> coupled;
  if (is_coupled) {
    coupled =
        std::make_unique<CoupledCase>(SceneBulk(scene, loaded.plan, loaded.mesh), solver, context);
  } else {
    simulation.prepare(context, scene.output.volume_fields);
  }
  const PreparedOperator prepared = is_coupled ? PreparedOperator() : simulation.prepared();
  const FaultOperator& faults = is_coupled ? coupled->faults() : *prepared.op;
  monitor.clear();
  if (!json) std::cerr << prepared_text(faults, prepared.surface, prepared.from_cache, is_coupled);

  std::optional<FieldWriter> writer;
  if (scene.output.fault_fields) {
    writer.emplace(output.path(), faults.geometry, loaded.plan.creep.active);
  }
  if (!json) std::cout << step_table_header(scene, plan.plane_strain, arguments.wide);
  context.monitor = nullptr;  // the table is progress enough
  RunWatch watch;
  watch.step = [&](const StepResult& step, const FaultFields& fields) {
    if (!json) std::cout << step_table_row(step, arguments.wide) << std::flush;
    if (writer) writer->add_step(step, fields);
  };
  std::vector<VolumeSnapshot> volume;
  if (scene.output.volume_fields) {
    watch.displaced = [&](const StepResult& step, const Eigen::Matrix3Xd& displacement) {
      volume.push_back({step.stage, step.time, displacement});
    };
  }
  std::string trace;
  if (arguments.trace) {
    watch.tried = [&](int step, const SubStepTrace& part) {
      if (!json) std::cout << trace_text(step, part);
      trace += trace_to_json(step, part).dump() + "\n";
    };
  }
  const CaseResult result =
      is_coupled ? coupled->run(context, {watch}) : simulation.run(context, watch);
  if (arguments.trace) write_text(output.path() / "trace.jsonl", trace);
  if (writer) writer->finish();
  if (scene.output.volume_fields) {
    const Mesh& mesh = is_coupled ? coupled->mesh() : prepared.bulk->bulk(0).problem().mesh;
    add_cell_changes(scene, mesh, loaded.plan.half_domain, volume);
    write_volume(output.path(), mesh.nodes, {mesh.cells.nodes(), mesh.cells.n_nodes()},
                 mesh.material, volume);
  }
  nlohmann::json document = result_to_json(result);
  document["initial_state"] = initial_state_to_json(loaded.plan.initial);
  if (!prepared.integrals.empty())
    document["field_integrals"] = field_integrals_to_json(prepared.integrals);
  const std::string text = json_text(std::move(document));
  write_text(output.path() / "result.json", text);
  const bool finished = result.outcome != Outcome::interrupted;
  if (finished) {
    output.commit();
  } else {
    output.keep_unfinished();
  }
  if (json) {
    std::cout << text;
  } else {
    if (result.failed_step) std::cout << step_table_row(result.steps.back(), arguments.wide);
    std::cout << case_summary(result)
              << field_integrals_to_text(prepared.integrals, result.plane_strain);
    if (finished) {
      std::cerr << "results in " << folder.string() << "/ (result.json, faults.xmf for ParaView)\n";
    } else {
      std::cerr << "interrupted: what was reached is in " << output.path().string() << "/\n";
    }
  }
  return exit_code_of(result.outcome);
}

}  // namespace faultsim
