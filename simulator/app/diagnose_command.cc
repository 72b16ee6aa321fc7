#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "simulator/app/load_scene.h"
#include "simulator/app/program.h"
#include "simulator/files/json_text.h"
#include "simulator/loading/diagnosis.h"
#include "simulator/loading/run_case.h"
#include "simulator/simulation/inside.h"

namespace faultsim {
namespace {

using nlohmann::json;

struct DiagnoseArguments {
  SceneArguments scene;
  OperatorArguments op;
};

/// JSON has no infinity: null.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const Diagnosis& d) {
  json violations = json::array();
  for (const Violation& v : d.violations) {
    violations.push_back({{"what", v.what}, {"told_by_result", v.told}});
  }
  const Misses& w = d.worst.relative;
  return {{"identity", d.result.identity},
          {"outcome", to_string(d.result.outcome)},
          {"reason", d.result.reason},
          {"warnings", d.result.warnings},
          {"n_events", d.result.events.size()},
          {"seconds", d.result.seconds},
          {"n_steps", d.n_steps},
          {"n_steps_with_equilibrium_recomputed", d.n_elastic},
          {"n_steps_with_flow_rule_checked", d.n_at_once},
          {"worst_step", d.worst_step},
          {"residual",
           {{"worst", number(w.largest())},
            {"equilibrium", number(w.equilibrium)},
            {"tension", number(w.tension)},
            {"penetration", number(w.penetration)},
            {"over_limit", number(w.over_limit)},
            {"slip_below_limit", number(w.below_limit)},
            {"misaligned", number(w.misaligned)},
            {"open_traction", number(w.open_traction)},
            {"memory", number(w.memory)}}},
          {"energy",
           {{"worst", number(d.worst.largest_energy())},
            {"identity", number(d.worst.energy)},
            {"negative_dissipation", number(d.worst.negative_dissipation)},
            {"negative_strain_energy", number(d.worst.negative_energy)}}},
          {"operator",
           {{"asymmetry", number(d.op.asymmetry)},
            {"positive_definite", d.op.condition.has_value()},
            {"condition", d.op.condition ? number(*d.op.condition) : json(nullptr)}}},
          {"noise",
           {{"relative_size", NoiseCheck::kNoise},
            {"chi_bar_change", number(d.noise.chi_bar_change)},
            {"slip_change", number(d.noise.slip_change)},
            {"amplification", number(d.noise.amplification())},
            {"changed", d.noise.changed}}},
          {"sound", d.sound()},
          {"violations", std::move(violations)}};
}

void print(const Diagnosis& d) {
  const Misses& w = d.worst.relative;
  std::printf("outcome: %s%s%s, %d load steps in equilibrium, %zu slip events\n",
              to_string(d.result.outcome), d.result.reason.empty() ? "" : ", ",
              d.result.reason.c_str(), d.n_steps, d.result.events.size());
  std::printf(
      "residual: %.1e of the traction level at worst, in step %d (equilibrium recomputed in %d "
      "steps, flow rule in %d)\n",
      w.largest(), d.worst_step, d.n_elastic, d.n_at_once);
  std::printf(
      "  equilibrium %.1e, tension %.1e, penetration %.1e, over the limit %.1e,\n"
      "  slip below the limit %.1e, slip off the traction %.1e, traction of open nodes %.1e,\n"
      "  memory of slip and cohesion %.1e\n",
      w.equilibrium, w.tension, w.penetration, w.over_limit, w.below_limit, w.misaligned,
      w.open_traction, w.memory);
  std::printf("energy: identity missed by %.1e, negative dissipation %.1e, strain energy %.1e\n",
              d.worst.energy, d.worst.negative_dissipation, d.worst.negative_energy);
  std::printf("operator: asymmetry %.1e, ", d.op.asymmetry);
  if (d.op.condition) {
    std::printf("positive definite, condition %.1e\n", *d.op.condition);
  } else {
    std::printf("NOT POSITIVE DEFINITE\n");
  }
  std::printf("noise of 1e-12 in the loads: changes chi_bar by %.1e, slip by %.1e of the largest\n",
              d.noise.chi_bar_change, d.noise.slip_change);
  for (const Violation& v : d.violations) {
    std::printf("flag: %s%s\n", v.what.c_str(), v.told ? " (the result says so)" : "");
  }
  for (const std::string& warning : d.result.warnings)
    std::printf("warning of the result: %s\n", warning.c_str());
  std::printf("verdict: %s\n", d.sound() ? "sound" : "flagged");
}

/// Runs a scene, checks every step from outside the solver and runs it again with noise in its
/// loads. Ends with regress when a limit is not met.
ExitCode diagnose_command(const DiagnoseArguments& arguments) {
  Simulation simulation = load_simulation(arguments.scene, arguments.op);
  const PreparedOperator& prepared =
      prepare_on_screen(simulation, arguments.op, arguments.scene.json);
  SilentMonitor silent;
  const Diagnosis diagnosis =
      diagnose_case(Inside::scene(simulation).scene, prepared, context_of(arguments.op, silent));
  if (arguments.scene.json) {
    std::cout << json_text(to_json(diagnosis));
  } else {
    print(diagnosis);
  }
  const ExitCode code = exit_code_of(diagnosis.result.outcome);
  if (code != ExitCode::done) return code;
  return diagnosis.sound() ? ExitCode::done : ExitCode::regress;
}

}  // namespace

void add_diagnose(Program& program) {
  auto [command, a] =
      program.add("diagnose", "run a scene, check it from outside the solver, and again with noise",
                  diagnose_command);
  add_scene(command, a.scene);
  add_operator(command, a.op);
  command->footer(
      "Examples:\n"
      "  faultsim diagnose my-field.json --set offset_east=\"200 m\"\n"
      "  faultsim diagnose my-field.json --tier screening --json\n"
      "Recomputes equilibrium, contact and energies of every load step in extended precision,\n"
      "tests the operator, and runs the case again with noise of 1e-12 in its loads. Exit code 5\n"
      "when a limit is not met; see docs/model.md, section 10.");
}

}  // namespace faultsim
