#include <cstdio>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/app/export_study.h"
#include "simulator/app/load_scene.h"
#include "simulator/app/program.h"
#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/coupled/box_study.h"
#include "simulator/coupled/solver_study.h"
#include "simulator/coupled/study_cases.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/linalg/blas.h"
#include "simulator/operators/prepare_operator.h"

namespace faultsim {
namespace {

struct SolverStudyArguments {
  SceneArguments scene;  ///< studied instead of the cases where it has a file.
  std::vector<std::string> cases = {"box"}, stages = {"stick"};  ///< StudyCase, FaultStage, "all".
  std::vector<std::string> cell_sizes = {"1/2", "1/4"};          ///< h of the box, "1/8".
  std::vector<std::string> leading = {"exact"}, schur = {"fsai+dir", "bds", "lsc"};  ///< or "all".
  std::string form = "upper";
  int fsai_steps = 0, fsai_step_size = 0;  ///< 0 = as FsaiOptions.
  double fsai_tolerance = 0;
  int max_iterations = 500;
  std::filesystem::path export_to;  ///< folder for the systems; empty = they are solved.
  bool json = false;
};

/// A body to be studied, and how it is called.
struct StudyBody {
  std::string name, folder;  ///< "1/8", "field-b", "scene"; "box-8", "field-b", "rotliegend".
  bool is_box = false;
  std::function<BulkProblem()> problem;
};

StudyBody box_body(int cells_per_metre) {
  return {concat("1/", cells_per_metre), concat("box-", cells_per_metre), true,
          [=] { return box_study(cells_per_metre); }};
}

StudyBody stand_in(StudyCase which) {
  return {to_string(which), to_string(which), false, [=] { return study_case(which); }};
}

StudyBody scene_body(const SceneArguments& arguments) {
  const auto loaded = std::make_shared<const LoadedScene>(load_scene(arguments));
  return {"scene", std::filesystem::path(arguments.file).stem(), false,
          [=] { return bulk_problem(loaded->scene, loaded->plan); }};
}

/// What is to be studied, in order.
struct Study {
  std::vector<StudyBody> bodies;
  std::vector<FaultStage> stages;
  std::vector<LeadingKind> leading;
  std::vector<SchurKind> schur;
  SolverChoice common;
};

/// The kinds of the names given, "all" for every one; names that are none become problems.
template <typename Kind>
std::vector<Kind> kinds_of(const std::vector<std::string>& names, const char* option,
                           std::vector<Problem>& problems) {
  constexpr auto all = enumerators<Kind>();
  std::vector<Kind> kinds;
  for (const std::string& name : names) {
    if (name == "all") {
      kinds.insert(kinds.end(), all.begin(), all.end());
    } else if (const auto kind = named<Kind>(name)) {
      kinds.push_back(*kind);
    } else {
      problems.push_back({"", 0, concat(option, " ", name, " is not known"),
                          "choose from all, " + joined(words(Kind()), ", ")});
    }
  }
  return kinds;
}

int cells_per_metre(const std::string& h, std::vector<Problem>& problems) {
  int n = 0, length = 0;
  const bool read =
      std::sscanf(h.c_str(), "1/%d%n", &n, &length) == 1 && length == static_cast<int>(h.size());
  if (read && n >= 2 && n <= 64 && n % 2 == 0) return n;
  problems.push_back({"", 0, concat("--h ", h, " is not a cell size of the box"),
                      "write 1/2, 1/4, 1/8, 1/16, ... 1/64: the plane z = 1/2 needs cells that "
                      "divide it"});
  return 0;
}

/// A scene instead of the cases where one is given.
std::vector<StudyBody> bodies_of(const SolverStudyArguments& arguments,
                                 std::vector<Problem>& problems) {
  if (!arguments.scene.file.empty()) return {scene_body(arguments.scene)};
  std::vector<StudyBody> bodies;
  for (const StudyCase which : kinds_of<StudyCase>(arguments.cases, "--case", problems)) {
    if (which != StudyCase::box) {
      bodies.push_back(stand_in(which));
      continue;
    }
    for (const std::string& h : arguments.cell_sizes)
      bodies.push_back(box_body(cells_per_metre(h, problems)));
  }
  return bodies;
}

Study read_study(const SolverStudyArguments& arguments) {
  std::vector<Problem> problems;
  Study study;
  study.bodies = bodies_of(arguments, problems);
  study.stages = kinds_of<FaultStage>(arguments.stages, "--stage", problems);
  study.leading = kinds_of<LeadingKind>(arguments.leading, "--leading", problems);
  study.schur = kinds_of<SchurKind>(arguments.schur, "--schur", problems);
  if (!problems.empty()) throw InputError("faultsim solver-study", problems);
  study.common.form = arguments.form == "full" ? BlockForm::full : BlockForm::upper;
  FsaiOptions& fsai = study.common.fsai;
  if (arguments.fsai_steps > 0) fsai.steps = arguments.fsai_steps;
  if (arguments.fsai_step_size > 0) fsai.step_size = arguments.fsai_step_size;
  if (arguments.fsai_tolerance > 0) fsai.tolerance = arguments.fsai_tolerance;
  return study;
}

nlohmann::ordered_json to_json(const StudyRow& row, const StudyBody& body, FaultStage stage) {
  const auto count = [](int iterations) {
    return iterations < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(iterations);
  };
  nlohmann::ordered_json out = {
      {"case", body.is_box ? "box" : body.folder},
      {"h", body.is_box ? nlohmann::ordered_json(body.name) : nlohmann::ordered_json()},
      {"stage", to_string(stage)},
      {"displacement_dofs", row.n_displacements},
      {"multiplier_dofs", row.n_multipliers},
      {"leading_nonzeros", row.leading_nonzeros},
      {"constraint_nonzeros", row.constraint_nonzeros},
      {"leading", to_string(row.choice.leading)},
      {"schur", to_string(row.choice.schur)},
      {"form", to_string(row.choice.form)},
      {"fsai",
       {{"steps", row.choice.fsai.steps},
        {"step_size", row.choice.fsai.step_size},
        {"tolerance", row.choice.fsai.tolerance}}},
      {"random", {{"1e-6", count(row.random.to_1e6)}, {"1e-8", count(row.random.to_1e8)}}},
      {"physical", {{"1e-6", count(row.physical.to_1e6)}, {"1e-8", count(row.physical.to_1e8)}}},
      {"setup_s", row.setup_seconds},
      {"solve_s", row.solve_seconds},
      {"true_residual", row.true_residual},
      {"preconditioner_bytes", row.bytes}};
  if (!row.failure.empty()) out["failure"] = row.failure;
  return out;
}

void print_header() {
  std::printf(
      "                                                    random rhs   physical rhs   processor, "
      "s\n");
  std::printf("%-7s %8s %7s %-5s  %-6s %-9s  %5s %5s  %5s %5s  %7s %7s %7s\n", "h", "u dofs",
              "λ dofs", "stage", "K + E", "Schur", "1e-6", "1e-8", "1e-6", "1e-8", "set-up",
              "solve", "MB");
}

void print_row(const StudyRow& row, const StudyBody& body, FaultStage stage) {
  const auto text = [](int count) { return count < 0 ? std::string("-") : std::to_string(count); };
  std::printf(
      "%-7s %8d %7d %-5s  %-6s %-9s  %5s %5s  %5s %5s  %7.2f %7.2f %7.1f%s%s\n", body.name.c_str(),
      row.n_displacements, row.n_multipliers, to_string(stage), to_string(row.choice.leading),
      to_string(row.choice.schur), text(row.random.to_1e6).c_str(), text(row.random.to_1e8).c_str(),
      text(row.physical.to_1e6).c_str(), text(row.physical.to_1e8).c_str(), row.setup_seconds,
      row.solve_seconds, row.bytes / 1e6, row.failure.empty() ? "" : "  ", row.failure.c_str());
  std::fflush(stdout);
}

/// Writes the systems instead of solving them, each into a folder: box-8-stick, field-a-slip, …
ExitCode export_systems(const Study& todo, const SolverStudyArguments& arguments) {
  require_writable_folder("--export", arguments.export_to);
  nlohmann::ordered_json exported = nlohmann::ordered_json::array();
  for (const StudyBody& body : todo.bodies) {
    const BulkProblem problem = body.problem();
    const TwoSidedBulk bulk(problem);
    for (const FaultStage stage : todo.stages) {
      const std::filesystem::path target =
          arguments.export_to / concat(body.folder, "-", to_string(stage));
      export_study(target, bulk, make_saddle_point(bulk, stage_of(problem.mesh, stage)));
      exported.push_back(target.string());
      if (!arguments.json) std::printf("wrote %s\n", target.c_str());
    }
  }
  const nlohmann::ordered_json none = nlohmann::ordered_json::array();
  if (arguments.json) {
    std::cout << json_text(nlohmann::ordered_json{{"rows", none}, {"exported", exported}});
  }
  return ExitCode::done;
}

/// All solvers on one system; visit(row).
template <typename Visit>
void study_system(const Study& todo, const TwoSidedBulk& bulk, const SaddlePoint& j,
                  int max_iterations, const Visit& visit) {
  for (const LeadingKind leading : todo.leading) {
    for (const SchurKind schur : todo.schur) {
      SolverChoice choice = todo.common;
      choice.leading = leading;
      choice.schur = schur;
      visit(study(bulk, j, choice, max_iterations));
    }
  }
}

ExitCode solver_study_command(const SolverStudyArguments& arguments) {
  const Study todo = read_study(arguments);
  set_blas_threads(1);
  if (!arguments.export_to.empty()) return export_systems(todo, arguments);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!arguments.json) print_header();
  for (const StudyBody& body : todo.bodies) {
    const BulkProblem problem = body.problem();
    const TwoSidedBulk bulk(problem);
    for (const FaultStage stage : todo.stages) {
      const SaddlePoint j = make_saddle_point(bulk, stage_of(problem.mesh, stage));
      study_system(todo, bulk, j, arguments.max_iterations, [&](const StudyRow& row) {
        if (arguments.json) {
          rows.push_back(to_json(row, body, stage));
        } else {
          print_row(row, body, stage);
        }
      });
    }
  }
  if (arguments.json) std::cout << json_text(nlohmann::ordered_json{{"rows", rows}});
  return ExitCode::done;
}

/// What is solved.
void add_systems(CLI::App* command, SolverStudyArguments& a) {
  CLI::Option* scene = command->add_option(
      "--scene", a.scene.file,
      "the body of a scene instead: its mesh, materials and boundary conditions");
  add_changes(command, a.scene);
  command->get_option("--set")->needs(scene);
  command->get_option("--tier")->needs(scene);
  command
      ->add_option("--case", a.cases,
                   "box (default), or stand-ins: 15-cuts,field-a,field-b,field-c; or all")
      ->delimiter(',')
      ->excludes(scene);
  command
      ->add_option("--stage", a.stages,
                   "states of the nodes: stick,slip,open, or all: a history (default stick)")
      ->delimiter(',');
  command
      ->add_option("--h", a.cell_sizes,
                   "cell sizes of the box: 1/2,1/4,1/8,1/16 … (default 1/2,1/4)")
      ->delimiter(',')
      ->excludes(scene);
}

/// By what.
void add_solvers(CLI::App* command, SolverStudyArguments& a) {
  command
      ->add_option("--leading", a.leading,
                   "for K + E: exact,fsai,ic,ilu,amg,amg-u or all (default exact)")
      ->delimiter(',');
  command
      ->add_option("--schur", a.schur,
                   "for S: exact,fsai+dir,fsai+fsai,bds,lsc,rac or all (default: three)")
      ->delimiter(',');
  command->add_option("--form", a.form, "upper (default) or full: two leading solves an iteration")
      ->check(CLI::IsMember({"full", "upper"}));
  command->add_option("--fsai-steps", a.fsai_steps, "growth steps of FSAI (default 5)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--fsai-step-size", a.fsai_step_size, "entries per step (default 1)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--fsai-tolerance", a.fsai_tolerance, "of a step (default 0.01)")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-iterations", a.max_iterations, "of GMRES (default 500)")
      ->check(CLI::Range(1, 100000));
}

}  // namespace

void add_solver_study(Program& program) {
  auto [command, a] =
      program.add("solver-study", "preconditioners of the coupled path on a published cracked box",
                  solver_study_command);
  add_systems(command, a);
  add_solvers(command, a);
  command->add_option("--export", a.export_to,
                      "write the systems as PETSc files into a folder, and solve nothing");
  add_json(command, a.json);
  command->footer(
      "Examples:\n"
      "  faultsim solver-study --h 1/2 --leading all --schur all\n"
      "  faultsim solver-study --h 1/8 --leading exact,amg --json\n"
      "  faultsim solver-study --case field-b --stage all --leading amg-u --schur rac\n"
      "  faultsim solver-study --scene my-field.json --tier standard --leading amg-u --schur rac\n"
      "Right-preconditioned GMRES without restart on J = [[K + E, C - F], [C^T, 0]];\n"
      "iterations to 1e-6 and 1e-8 of a random and a physical right-hand side. See\n"
      "docs/model.md, section 11.");
}

}  // namespace faultsim
