#include <array>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/app/load_scene.h"
#include "simulator/app/program.h"
#include "simulator/common/text.h"
#include "simulator/contact/contact_export.h"
#include "simulator/files/json_text.h"
#include "simulator/files/output_target.h"
#include "simulator/plan/combinations.h"
#include "simulator/result_files/fclib_writer.h"
#include "simulator/simulation/inside.h"

namespace faultsim {
namespace {

/// A step's problem with our solution, and what is to be said of both.
struct ExportedStep {
  StepStart start;
  FrictionalContactProblem problem;
  std::optional<FrictionalContactSolution> solution;
  std::string failure;  ///< why there is no solution.
  int n_slip = 0, n_open = 0;
  double natural_map = 0, equilibrium = 0;  ///< relative to |r|, to |q|.
};

/// The exported problem is that of the whole step: solved here without sub-steps and by the frozen
/// laws, which need not be how `run` went through the step.
void solve(const FaultOperator& op, const ContactLaws& frozen, const LoadStepProblem& step,
           ExportedStep& exported) {
  ContactOptions options = exported.start.options;
  options.max_step_cuts = 0;
  ContactState end = step.start;
  const ContactReport report =
      ContactSolver(op, frozen, options).solve_step(step.before, step.after, end);
  if (report.outcome != Outcome::converged) {
    exported.failure = report.reason;
    return;
  }
  exported.solution = frictional_contact_solution(op, exported.problem, step, end);
  for (const FaultState state : end.state) {
    exported.n_slip += state == FaultState::slip;
    exported.n_open += state == FaultState::open;
  }
  const auto relative = [](double error, double size) { return size > 0 ? error / size : error; };
  exported.natural_map = relative(natural_map_error(exported.problem, *exported.solution),
                                  exported.solution->r.norm());
  exported.equilibrium =
      relative(equilibrium_error(exported.problem, *exported.solution), exported.problem.q.norm());
}

FrictionalContactInfo about(const LoadedScene& loaded, const FaultOperator& op,
                            const ExportedStep& exported) {
  FrictionalContactInfo info;
  info.title = concat(loaded.scene.title, ", load step ", exported.start.step.step, " (",
                      exported.start.step.stage, ")");
  const std::string faults = joined(op.geometry.faults, ", ", [](const OperatorFault& fault) {
    return concat(fault.name, " (", fault.n_nodes, ")");
  });
  info.description = concat(
      "Quasi-static contact of faults in an elastic body, condensed on the fault nodes. Faults and "
      "their contacts, in order: ",
      faults, ". Contacts have ",
      exported.problem.dimension == 2 ? "normal, shear" : "normal, strike, dip",
      " components. u: gap, and slip of the step, in ", exported.problem.displacement_unit,
      " m; r: force, compression positive, in ", exported.problem.force_unit,
      " N. Friction is frozen at the start of the step. Case ", case_identity(loaded.scene),
      ", operator ", op.fingerprint, ".");
  info.math_info = "W is dense, symmetric, positive definite: the inverse of a condensed stiffness";
  return info;
}

void report(const ExportArguments& arguments, const ExportedStep& exported) {
  const FrictionalContactProblem& problem = exported.problem;
  if (arguments.scene.json) {
    nlohmann::json out = {
        {"file", arguments.output.string()},  {"load_step", exported.start.step.step},
        {"stage", exported.start.step.stage}, {"dimension", problem.dimension},
        {"n_contacts", problem.n_contacts()}, {"displacement_unit_m", problem.displacement_unit},
        {"force_unit_n", problem.force_unit}, {"solution", nullptr}};
    if (exported.solution) {
      out["solution"] = {{"n_slip", exported.n_slip},
                         {"n_open", exported.n_open},
                         {"natural_map_error", exported.natural_map},
                         {"equilibrium_error", exported.equilibrium}};
    }
    std::cout << json_text(std::move(out));
    return;
  }
  std::printf("%s: load step %d (%s), %d contacts in %dD, units %g m and %g N\n",
              arguments.output.c_str(), exported.start.step.step, exported.start.step.stage.c_str(),
              problem.n_contacts(), problem.dimension, problem.displacement_unit,
              problem.force_unit);
  if (exported.solution) {
    std::printf("solution: %d slip, %d open; natural-map error %.1e |r|, |u - W r - q| %.1e |q|\n",
                exported.n_slip, exported.n_open, exported.natural_map, exported.equilibrium);
  }
}

}  // namespace

ExitCode export_contact_command(const ExportArguments& arguments) {
  Simulation simulation = load_simulation(arguments.scene, arguments.op);
  const LoadedScene& loaded = Inside::scene(simulation);
  require_writable_file("-o", arguments.output, FileKind::hdf5, input_files(loaded));
  std::vector<Problem> problems =
      unsupported(loaded.scene, loaded.plan, std::array{Feature::contact_problem});
  if (!problems.empty()) throw InputError(loaded.document.source, std::move(problems));
  const PreparedOperator& prepared =
      prepare_on_screen(simulation, arguments.op, arguments.scene.json);
  const FaultOperator& op = *prepared.op;

  ExportedStep exported;
  SilentMonitor silent;
  exported.start =
      start_of_step(loaded.scene, prepared, arguments.step, context_of(arguments.op, silent));
  if (exported.start.outcome != Outcome::converged) {
    std::cerr << "no problem to write: the case ends before load step " << arguments.step << ": "
              << exported.start.reason << "\n";
    return exit_code_of(exported.start.outcome);
  }
  const ContactLaws frozen =
      frozen_laws(op, exported.start.laws, exported.start.state,
                  arguments.freeze_strength ? Weakening::freeze : Weakening::refuse);
  const LoadStepProblem step{exported.start.before, exported.start.after, exported.start.state};
  exported.problem = frictional_contact_problem(op, frozen, step);
  solve(op, frozen, step, exported);
  write_fclib(arguments.output, exported.problem, about(loaded, op, exported),
              exported.solution ? &*exported.solution : nullptr);
  report(arguments, exported);
  if (exported.solution) return ExitCode::done;
  std::cerr << "the problem was written without a solution: " << exported.failure << "\n";
  return ExitCode::no_convergence;
}

void add_export_contact(Program& program) {
  auto [command, a] = program.add("export-contact",
                                  "write the contact problem of a load step as an FCLib HDF5 file",
                                  export_contact_command);
  add_scene(command, a.scene);
  command->add_option("--step", a.step, "load step; 0 = the initial equilibrium")->required();
  command->add_option("-o,--output", a.output, "file to write")->required();
  command->add_flag("--freeze-strength", a.freeze_strength,
                    "friction that weakens keeps its value at the start of the step");
  add_operator(command, a.op);
  command->footer(
      "Examples:\n"
      "  faultsim export-contact my-field.json --step 10 -o step10.hdf5\n"
      "  faultsim export-contact my-field.json --step 10 --freeze-strength -o step10.hdf5\n"
      "Runs the scene up to the step before, and writes u = W r + q, friction coefficients and\n"
      "our solution. The step must have no cohesion; see docs/contact-export.md.");
}

}  // namespace faultsim
