#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/app/load_scene.h"
#include "simulator/app/program.h"
#include "simulator/app/screen.h"
#include "simulator/app/together.h"
#include "simulator/app/trace_text.h"
#include "simulator/common/machine.h"
#include "simulator/common/text.h"
#include "simulator/common/thread_team.h"
#include "simulator/coupled/ranks.h"
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
#include "simulator/simulation/inside.h"

namespace faultsim {
namespace {

std::string built_in(double seconds) { return formatted("operator: built in %.2f s", seconds); }

/// What the arguments ask for; automatic chooses by the plan. Throws InputError when the coupled
/// path is asked for and cannot take the scene, or several ranks take another.
PathChoice path_of(const RunArguments& arguments, const LoadedScene& loaded, const Ranks& ranks) {
  if (ranks.size() > 1 && arguments.path != "coupled")
    throw InputError("faultsim run", "the condensed path runs in one process",
                     "start it without mpirun, or add --path coupled");
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

/// A run that is known to be possible, and its folder: which only the first rank has.
class Run {
 public:
  Run(const RunArguments& arguments, const Ranks& ranks);
  ExitCode walk();

 private:
  bool is_coupled() const { return choice_.path == SolutionPath::coupled; }
  void write(const char* name, const std::string& text) const {
    if (output_) write_text(output_->path() / name, text);
  }
  void say_what_is_planned() const;
  void prepare(const RunContext& context);
  RunWatch watch();
  void write_fields();
  void close(const CaseResult& result);

  const RunArguments& arguments_;
  Ranks ranks_;
  SolverChoice solver_;
  Simulation simulation_;
  const LoadedScene& loaded_;
  const Scene& scene_;
  Plan plan_;
  PathChoice choice_;
  std::filesystem::path folder_;
  std::optional<ResultFolder> output_;
  ScreenMonitor monitor_;

  std::unique_ptr<CoupledCase> coupled_;
  PreparedOperator prepared_;
  std::optional<FieldWriter> writer_;
  std::vector<VolumeSnapshot> volume_;
  std::string trace_;
};

Run::Run(const RunArguments& arguments, const Ranks& ranks)
    : arguments_(arguments),
      ranks_(ranks),
      solver_(solver_of(arguments.leading, arguments.schur)),
      simulation_(load_simulation(arguments.scene, arguments.op, arguments.exact)),
      loaded_(Inside::scene(simulation_)),
      scene_(loaded_.scene),
      plan_(loaded_.plan),
      monitor_(arguments.scene.json) {
  simulation_.check();
  add_savings(scene_, plan_);
  choice_ = path_of(arguments, loaded_, ranks);
  if (is_coupled()) require_runs_on_ranks(solver_, ranks.size());
  if (const std::string complaint = blas_complaint(); !complaint.empty())
    std::cerr << complaint << "\n";
  folder_ = arguments.output.empty()
                ? std::filesystem::path(
                      std::filesystem::path(arguments.scene.file).stem().string() + "-result")
                : arguments.output;
  if (ranks.rank() == 0) {
    output_.emplace(
        ResultFolder::Request{.option = "-o",
                              .folder = folder_,
                              .made_by = "faultsim run",
                              .names = {"plan.json", "scene.json", "result.json", "faults.h5",
                                        "faults.xmf", "volume.h5", "volume.xmf", "trace.jsonl"},
                              .inputs = input_files(loaded_)});
  }
  nlohmann::json planned = plan_to_json(plan_);
  planned["path"] = {{"name", to_string(choice_.path)}, {"reason", choice_.reason}};
  write("plan.json", json_text(planned));
  write("scene.json", loaded_.document.value.dump(2) + "\n");
}

void Run::say_what_is_planned() const {
  std::cerr << plan_to_text(plan_) << "linear algebra: " << blas_description() << " ("
            << blas_kernel_reason() << ")\n"
            << remarks_to_text(loaded_);
  if (arguments_.path != "condensed")
    std::cerr << "path: " << to_string(choice_.path) << ", " << choice_.reason << "\n";
  if (ranks_.size() > 1)
    std::cerr << "ranks: " << ranks_.size() << ", each with a part of the rock\n";
}

void Run::prepare(const RunContext& context) {
  if (is_coupled()) {
    coupled_ = std::make_unique<CoupledCase>(SceneBulk(scene_, loaded_.plan, loaded_.mesh), solver_,
                                             context, ranks_);
  } else {
    simulation_.prepare(context, scene_.output.volume_fields);
    prepared_ = Inside::prepared(simulation_);
  }
  const FaultOperator& faults = is_coupled() ? coupled_->faults() : *prepared_.op;
  monitor_.clear();
  if (!arguments_.scene.json)
    std::cerr << prepared_text(faults, prepared_.surface, prepared_.from_cache, is_coupled());
  if (scene_.output.fault_fields && output_)
    writer_.emplace(output_->path(), faults.geometry, loaded_.plan.creep.active);
}

RunWatch Run::watch() {
  RunWatch watch;
  watch.step = [this](const StepResult& step, const FaultFields& fields) {
    if (!arguments_.scene.json) std::cout << step_table_row(step, arguments_.wide) << std::flush;
    if (writer_) writer_->add_step(step, fields);
  };
  if (scene_.output.volume_fields) {
    watch.displaced = [this](const StepResult& step, const Eigen::Matrix3Xd& displacement) {
      if (output_) volume_.push_back({step.stage, step.time, displacement});
    };
  }
  if (arguments_.trace) {
    watch.tried = [this](int step, const SubStepTrace& part) {
      if (!arguments_.scene.json) std::cout << trace_text(step, part);
      trace_ += trace_to_json(step, part).dump() + "\n";
    };
  }
  return watch;
}

void Run::write_fields() {
  if (arguments_.trace) write("trace.jsonl", trace_);
  if (writer_) writer_->finish();
  if (!scene_.output.volume_fields || !output_) return;
  const Mesh& mesh = is_coupled() ? coupled_->mesh() : prepared_.bulk->bulk(0).problem().mesh;
  add_cell_changes(scene_, mesh, loaded_.plan.half_domain, volume_);
  write_volume(output_->path(), mesh.nodes, {mesh.cells.nodes(), mesh.cells.n_nodes()},
               mesh.material, volume_);
}

/// Writes and says what came out.
void Run::close(const CaseResult& result) {
  write_fields();
  nlohmann::json document = result_to_json(result);
  document["initial_state"] = initial_state_to_json(loaded_.plan.initial);
  if (!prepared_.integrals.empty())
    document["field_integrals"] = field_integrals_to_json(prepared_.integrals);
  const std::string text = json_text(std::move(document));
  write("result.json", text);
  const bool finished = result.outcome != Outcome::interrupted;
  if (output_ && finished) output_->commit();
  if (output_ && !finished) output_->keep_unfinished();
  if (arguments_.scene.json) {
    std::cout << text;
    return;
  }
  if (result.failed_step) std::cout << step_table_row(result.steps.back(), arguments_.wide);
  std::cout << case_summary(result)
            << field_integrals_to_text(prepared_.integrals, result.plane_strain);
  if (!output_) return;
  if (finished) {
    std::cerr << "results in " << folder_.string() << "/ (result.json, faults.xmf for ParaView)\n";
  } else {
    std::cerr << "interrupted: results so far are in " << output_->path().string() << "/\n";
  }
}

ExitCode Run::walk() {
  if (!arguments_.scene.json) say_what_is_planned();
  RunContext context = context_of(arguments_.op, monitor_);
  ThreadTeam team(std::min(context.n_threads, kMostThreadsOfCase));
  context.team = &team;
  prepare(context);
  if (!arguments_.scene.json)
    std::cout << step_table_header(scene_, plan_.plane_strain, arguments_.wide);
  context.monitor = nullptr;  // the table is progress enough
  const CaseResult result =
      is_coupled() ? coupled_->run(context, {watch()}) : simulation_.run(context, watch());
  close(result);
  return exit_code_of(result.outcome);
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
  std::optional<Run> run;
  return together([&](const Ranks& ranks) { run.emplace(arguments, ranks); },
                  [&] { return run->walk(); });
}

void add_run(Program& program) {
  auto [command, a] = program.add("run", "run a scene", run_command);
  CLI::Option* scene = add_scene(command, a.scene);
  command
      ->add_option_function<std::string>(
          "--from-report",
          [&file = a.scene.file, scene](const std::string& page) {
            file = page;
            scene->required(false);
          },
          "the scene of a page that report wrote, in place of a scene file")
      ->type_name("PAGE")
      ->excludes(scene)
      ->trigger_on_parse();
  command->add_option("-o,--output", a.output, "result folder (default SCENE-result)");
  add_operator(command, a.op, kBuildingAndCase);
  command->add_flag("--wide", a.wide, "the table with all its columns, however wide");
  command->add_flag("--trace", a.trace,
                    "how each load step was solved, iteration by iteration; also in trace.jsonl");
  command->add_flag("--exact", a.exact,
                    "the exact operator where the scene asks for a surface (/numerics/surface)");
  command
      ->add_option("--path", a.path,
                   "condensed (default); coupled: no operator, both sides of the faults and\n"
                   "multipliers; automatic: condensed if it fits in memory")
      ->check(CLI::IsMember({"condensed", "coupled", "automatic"}));
  command->add_option("--leading", a.leading,
                      "coupled path, for K + E: exact,fsai,ic,ilu,amg,amg-u (default amg-u)");
  command->add_option("--schur", a.schur,
                      "coupled path: exact,fsai+dir,fsai+fsai,bds,lsc,rac (default rac)");
  command->footer(
      "Examples:\n"
      "  faultsim run my-field.json -o out\n"
      "  faultsim run my-field.json --tier screening --set offset_east=\"150 m\" -o offset-150\n"
      "  mpirun -n 4 faultsim run my-field.json --path coupled -o out\n"
      "The folder holds one run: an earlier one is replaced when the new one is complete. Open\n"
      "out/faults.xmf in ParaView; see docs/commands.md.");
}

}  // namespace faultsim
