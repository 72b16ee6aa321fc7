// V8: a block of Maxwell salt under uniform strain or load, whose answers are closed forms in time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "simulator/common/errors.h"
#include "tests/verification/closed_forms/creep_solutions.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

const char kStrain[] = "v8_maxwell.json";
const char kColumn[] = "v8_column.json";
constexpr double kExact = 1e-10;
const Eigen::Matrix3d kNone = Eigen::Matrix3d::Zero();
const Setting kVertical = {"/faults/0/dip_from_vertical", "0 deg"};
const Setting kHorizontal = {"/faults/0/dip_from_vertical", "90 deg"};
const Setting kDipping = {"/faults/0/dip_from_vertical", "25 deg"};
const Setting kOblique = {"/faults/0", R"({
  "name": "F1", "center": ["0 m", "0 m", "-2 m"], "strike": "15 deg", "dip_from_vertical": "-20 deg",
  "length": "2 m", "width": "2 m"})"};
/// Loads that are there from the start, and loads that grow from 0 over the 50 τ of the scene.
const Setting kRamp = {"/geometry/boundary/0/table",
                       R"({"time": ["0 s", "325e6 s"], "factor": [0, 1]})"};
constexpr double kRampTime = 325e6;

Setting strain_of(const std::string& gradient) {
  return {"/geometry/boundary/0/gradient", gradient};
}

Setting seconds(const std::string& pointer, double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g s", value);
  return {pointer, text};
}

Setting time_step(double value) { return seconds("/numerics/creep_time_step", value); }

MaxwellSolid solid_of(const SceneRun& run) {
  const Material& salt = run.scene.materials.front();
  return {salt.youngs_modulus, salt.poisson_ratio, salt.viscosity.value()};
}

Eigen::Matrix3d prescribed_strain(const SceneRun& run) {
  const auto& gradient = run.scene.box.boundary.front().gradient;
  const Eigen::Matrix3d g =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(gradient.data());
  return (g + g.transpose()) / 2;
}

/// Change of the traction of a node since the initial state, x, y, z, Pa.
Eigen::Vector3d traction_change(const SceneRun& run, std::size_t step, std::size_t k) {
  const OperatorNode& node = run.geometry().nodes.at(k);
  const Eigen::Vector3d t = run.fields.at(step).traction.col(static_cast<Eigen::Index>(k));
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> initial(
      run.scene.initial.tensor->data());
  return node.normal * t[0] + node.strike * t[1] + node.dip * t[2] - initial * node.normal;
}

/// The component i of t = σ n over that of n, at the node where it is furthest from `expected`:
/// σ_i of a patch whose normal is the axis.
double worst_stress(const SceneRun& run, std::size_t step, int row, int axis, double expected) {
  double worst = expected;
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const double sign = run.geometry().nodes[k].normal[axis];
    const double computed = traction_change(run, step, k)[row] / sign;
    if (!(std::abs(computed - expected) <= std::abs(worst - expected))) worst = computed;
  }
  return worst;
}

/// Largest difference of a traction from σ n over all nodes and steps, relative to the largest |σ
/// n| of the step; NaN where any is.
template <typename Stress>
double worst_traction(const SceneRun& run, const Stress& stress) {
  double worst = 0;
  for (std::size_t step = 0; step < run.fields.size(); ++step) {
    const Eigen::Matrix3d sigma = stress(run.result.steps[step].time);
    double difference = 0, scale = 0;
    for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
      const Eigen::Vector3d expected = sigma * run.geometry().nodes[k].normal;
      const double here = (traction_change(run, step, k) - expected).norm();
      if (std::isnan(here)) return here;
      difference = std::max(difference, here);
      scale = std::max(scale, expected.norm());
    }
    if (scale > 0) worst = std::max(worst, difference / scale);
  }
  return worst;
}

double largest_jump(const SceneRun& run) {
  double largest = 0;
  for (const FaultFields& fields : run.fields) {
    largest = std::max(largest, fields.jump.cwiseAbs().maxCoeff());
  }
  return largest;
}

std::string at_time(const SceneRun& run, std::size_t step) {
  return "t/τ = " + short_number(run.result.steps[step].time / solid_of(run).relaxation_time());
}

/// σ_row of the patch with that normal at all steps of a run.
void compare_stress(const SceneRun& run, const std::string& what, const std::string& symbol,
                    int row, int axis, bool ramp, VerifyReport& report) {
  const Eigen::Matrix3d strain = prescribed_strain(run);
  for (std::size_t step = 0; step < run.fields.size(); ++step) {
    const double time = run.result.steps[step].time;
    const double expected =
        maxwell_stress(solid_of(run), ramp ? kNone : strain,
                       ramp ? Eigen::Matrix3d(strain / kRampTime) : kNone, time)(row, axis);
    const double largest = maxwell_stress(solid_of(run), strain, kNone, 0).cwiseAbs().maxCoeff();
    report.compare(concat(what, ": ", symbol, " at ", at_time(run, step)), "MPa", expected / 1e6,
                   worst_stress(run, step, row, axis, expected) / 1e6, kExact, largest / 1e6);
  }
  report.bound(what + ": largest jump", "m", largest_jump(run), 0);
}

/// One step per stage (of 1, 4 and 45 τ), steps of τ, and steps of τ/10.
const std::vector<std::pair<std::string, Setting>>& step_choices() {
  static const std::vector<std::pair<std::string, Setting>> choices = {
      {"3 steps", time_step(1e12)},
      {"50 steps", time_step(6.5e6)},
      {"500 steps", time_step(6.5e5)}};
  return choices;
}

/// The error control finds nothing to correct in what is exact at any step.
void check_error_control(SceneRunner& runner, const Settings& settings, VerifyReport& report) {
  Settings all = settings;
  all.push_back(
      {"/numerics", R"({"creep": "on", "creep_refinements": 2, "traction_tolerance": 1e-12})"});
  const SceneRun run = runner.run(kStrain, all);
  double error = 0;
  int steps = 0;
  for (const StepResult& step : run.result.steps) {
    error = std::max(error, step.creep->time_error);
    steps += step.creep->time_steps;
  }
  report.bound("error control: largest difference that it measures", "Pa", error, 1);
  report.compare("error control: steps of creep", "", 6, steps, 0);
}

VerifyCase confined_case() {
  return {
      "V8-confined",
      "salt: confined strain of 1e-3 held for 50 relaxation times",
      {kStrain},
      false,
      [](SceneRunner& runner, VerifyReport& report) {
        for (const auto& [name, steps] : step_choices()) {
          compare_stress(runner.run(kStrain, {kHorizontal, steps}), name, "σ_z", 2, 2, false,
                         report);
          compare_stress(runner.run(kStrain, {kVertical, steps}), name, "σ_x", 0, 0, false, report);
        }
        check_error_control(runner, {kDipping}, report);
        // 4.855 τ: what is left of the deviator of 20.512821 MPa
        const Settings year = {kHorizontal,
                               {"/stages", R"([{"name": "a_year", "duration": "1 year"}])"},
                               time_step(1e12),
                               {"/numerics/creep_scheme", "backward_euler"}};
        const SceneRun run = runner.run(kStrain, year);
        const double left = (worst_stress(run, 1, 2, 2, 0) - 100e9 / 3 * 1e-3) /
                            (4.0 / 3 * solid_of(run).shear_modulus() * 1e-3);
        report.compare("backward Euler: deviator left by one step of a year", "", 0.1708, left,
                       5e-5, 1);
      }};
}

VerifyCase rate_case() {
  return {"V8-rate",
          "salt: confined strain that grows for 50 relaxation times",
          {kStrain},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            for (const auto& [name, steps] : step_choices()) {
              compare_stress(runner.run(kStrain, {kHorizontal, kRamp, steps}), name, "σ_z", 2, 2,
                             true, report);
              compare_stress(runner.run(kStrain, {kVertical, kRamp, steps}), name, "σ_x", 0, 0,
                             true, report);
            }
            check_error_control(runner, {kDipping, kRamp}, report);
          }};
}

VerifyCase shear_case() {
  return {"V8-shear",
          "salt: simple shear of 1e-3 held for 50 relaxation times",
          {kStrain},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const Setting shear = strain_of("[[0, 0, 1e-3], [0, 0, 0], [0, 0, 0]]");
            for (const auto& [name, steps] : step_choices()) {
              compare_stress(runner.run(kStrain, {kHorizontal, shear, steps}), name, "σ_xz", 0, 2,
                             false, report);
            }
          }};
}

/// Everything at once: a full strain tensor that is there at the start and goes on growing, on
/// patches whose cells are sheared.
VerifyCase oriented_case() {
  return {"V8-oriented",
          "salt: a full strain tensor, held and growing, on dipping patches in sheared cells",
          {kStrain},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            const Settings patches[] = {{kDipping}, {kOblique}, {kHorizontal}};
            const char* names[] = {"dip 65°", "strike 15°, dip 70°", "horizontal"};
            for (int i = 0; i < 3; ++i) {
              for (const auto& [name, steps] : step_choices()) {
                Settings settings = patches[i];
                settings.push_back(
                    strain_of("[[1e-3, 2e-4, -3e-4], [5e-4, -4e-4, 1e-4], [6e-4, 0, -2e-4]]"));
                settings.push_back({"/geometry/boundary/0/table",
                                    R"({"time": ["0 s", "325e6 s"], "factor": [1, 3]})"});
                settings.push_back(steps);
                const SceneRun run = runner.run(kStrain, settings);
                const Eigen::Matrix3d strain = prescribed_strain(run);
                report.bound(concat(names[i], ", ", name, ": traction, worst node and time"),
                             "relative",
                             worst_traction(run,
                                            [&](double time) {
                                              return maxwell_stress(solid_of(run), strain,
                                                                    2 / kRampTime * strain, time);
                                            }),
                             kExact);
                report.bound(concat(names[i], ", ", name, ": largest jump"), "m", largest_jump(run),
                             0);
              }
            }
          }};
}

/// Errors of (b), relative to the load and to the strain in the end.
struct ColumnError {
  double stress = 0, strain = 0;
};

ColumnError column_error(const SceneRun& run, std::size_t step) {
  const double time = run.result.steps.at(step).time;
  const ConfinedColumn exact = confined_column(solid_of(run), -10e6, time);
  return {
      std::abs(worst_stress(run, step, 0, 0, exact.lateral_stress) - exact.lateral_stress) / 10e6,
      std::abs(run.observed("top.z", step) / 4 - exact.vertical_strain) / 3e-4};
}

void compare_column(const SceneRun& run, const std::string& what, double tolerance,
                    VerifyReport& report) {
  for (std::size_t step = 0; step < run.fields.size(); ++step) {
    const ConfinedColumn exact = confined_column(solid_of(run), -10e6, run.result.steps[step].time);
    const std::string where = " at " + at_time(run, step);
    const double allowed = step == 0 ? kExact : tolerance;
    report.compare(what + ": σ_x" + where, "MPa", exact.lateral_stress / 1e6,
                   worst_stress(run, step, 0, 0, exact.lateral_stress) / 1e6, allowed, 10);
    report.compare(what + ": ε_z" + where, "1e-4", exact.vertical_strain * 1e4,
                   run.observed("top.z", step) / 4 * 1e4, allowed, 3);
  }
}

/// The strain rate changes within a step: second order.
void check_order(SceneRunner& runner, VerifyReport& report) {
  ColumnError last;
  for (const int n : {4, 8, 16, 32}) {
    const SceneRun run = runner.run(kColumn, {kVertical, time_step(6.5e6 / n)});
    const ColumnError error = column_error(run, 1);
    if (n > 4) {
      const std::string steps = concat("order from steps of τ/", n / 2, " and τ/", n, ": ");
      report.at_least(steps + "σ_x", 1.98, observed_order(last.stress, error.stress));
      report.at_least(steps + "ε_z", 1.98, observed_order(last.strain, error.strain));
    }
    last = error;
  }
}

/// Where the error control calls a step resolved, its true error is within the tolerance; and it
/// says where 64 parts of a step are not enough.
void check_column_control(SceneRunner& runner, VerifyReport& report) {
  for (const double tolerance : {20e3, 2e3}) {
    const SceneRun run = runner.run(
        kColumn, {{"/numerics",
                   concat(R"({"creep": "on", "creep_refinements": 6, "traction_tolerance": 1e-12,
                     "creep_tolerance": ")",
                          tolerance, R"( Pa"})")}});
    const std::string what = "error control, " + short_number(tolerance / 1e3) + " kPa";
    for (std::size_t step = 1; step < run.fields.size(); ++step) {
      const StepCreep& creep = *run.result.steps[step].creep;
      const bool enough = step < 3 || tolerance > 1e4;
      report.holds(concat(what, enough ? ": " : ": not ", "resolved at ", at_time(run, step)),
                   creep.time_resolved == enough && (creep.time_error <= tolerance) == enough);
      report.bound(what + ": error of σ_x at " + at_time(run, step), "Pa",
                   column_error(run, step).stress * 10e6, tolerance);
    }
  }
}

VerifyCase column_case() {
  return {"V8-column",
          "salt: confined column under a constant load",
          {kColumn},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            compare_column(runner.run(kColumn, {kVertical, time_step(6.5e6 / 50)}), "2500 steps",
                           2e-5, report);
            check_order(runner, report);
            check_column_control(runner, report);
            const SceneRun run = runner.run(
                kColumn,
                {time_step(1e12), {"/stages", R"([{"name": "one", "duration": "325e6 s"}])"}});
            report.compare("one step of 50 τ: σ_x", "MPa", -10,
                           worst_stress(run, 1, 0, 0, -10e6) / 1e6, 0.05);
            report.holds("one step of 50 τ does not overshoot",
                         worst_stress(run, 1, 0, 0, -1e9) > -10e6);
          }};
}

/// One step of x relaxation times of salt of some viscosity: what is left of shear held, and what
/// shear applied within the step makes.
struct OneStep {
  double held = 0;     ///< σ_xz/(G γ), exactly e^{−x}
  double applied = 0;  ///< σ_xz/(G γ), exactly (1 − e^{−x})/x
};

OneStep one_step(SceneRunner& runner, double viscosity, double x) {
  const MaxwellSolid salt{40e9, 0.3, viscosity};
  const double duration = x * salt.relaxation_time(), shear = 1e-3;
  const auto run = [&](const Setting& table) {
    const Setting stage = {"/stages", R"([{"name": "one", "duration": "1 s"}])"};
    const SceneRun result =
        runner.run(kStrain, {kHorizontal,
                             strain_of("[[0, 0, 1e-3], [0, 0, 0], [0, 0, 0]]"),
                             stage,
                             table,
                             seconds("/stages/0/duration", duration),
                             time_step(2 * duration),
                             {"/materials/salt/viscosity", concat(viscosity, " Pa s")}});
    return worst_stress(result, 1, 0, 2, 0) / (salt.shear_modulus() * shear);
  };
  const auto table = [&](int first) {
    char text[120];
    std::snprintf(text, sizeof text, R"({"time": ["0 s", "%.17g s"], "factor": [%d, 1]})", duration,
                  first);
    return Setting{"/geometry/boundary/0/table", text};
  };
  return {run(table(1)), run(table(0))};
}

void check_extremes(SceneRunner& runner, double viscosity, VerifyReport& report) {
  const std::string salt = "η " + short_number(viscosity);
  for (const double x : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const std::string what = concat(salt, ", Δt/τ = ", short_number(x), ": σ_xz/Gγ, ");
    const OneStep found = one_step(runner, viscosity, x);
    report.compare(what + "held (error of 1)", "", std::exp(-x), found.held,
                   x > 100 ? 1e-12 : kExact, 1);
    report.compare(what + "applied", "", -std::expm1(-x) / x, found.applied, 1e-9);
    if (x == 1e-6) {
      report.compare(what + "held, against elastic", "", 1, found.held, 1e-6);
      report.compare(what + "applied, against elastic", "", 1, found.applied, 1e-6);
    }
    if (x == 1e6) report.compare(what + "applied, against 1/x", "", 1 / x, found.applied, 1e-6);
  }
}

/// A thousand steps of one length in confined strain: the pressure stays, to the last digits.
void check_drift(SceneRunner& runner, double x, VerifyReport& report) {
  const double step = x * 6.5e6;
  const SceneRun run = runner.run(kStrain, {kHorizontal,
                                            {"/stages", R"([{"name": "hold", "duration": "1 s"}])"},
                                            seconds("/stages/0/duration", 1000 * step),
                                            time_step(step)});
  const double exact =
      maxwell_stress(solid_of(run), prescribed_strain(run), kNone, 1000 * step)(2, 2);
  report.compare(concat("1000 steps of ", short_number(x), " τ: σ_z"), "MPa", exact / 1e6,
                 worst_stress(run, 1, 2, 2, exact) / 1e6, 1e-12);
}

VerifyCase extremes_case() {
  return {"V8-extremes",
          "salt: viscosities from 1e12 to 1e25 Pa s, steps from 1e-6 to 1e6 relaxation times",
          {kStrain, kColumn},
          false,
          [](SceneRunner& runner, VerifyReport& report) {
            for (const double viscosity : {1e12, 1e15, 1e17, 1e21, 1e25}) {
              check_extremes(runner, viscosity, report);
            }
            for (const double x : {1e-6, 1.0, 1e6}) check_drift(runner, x, report);
            const SceneRun liquid = runner.run(
                kColumn,
                {time_step(1e14), {"/stages", R"([{"name": "one", "duration": "6.5e12 s"}])"}});
            report.compare("column, one step of 1e6 τ: σ_x", "MPa", -10,
                           worst_stress(liquid, 1, 0, 0, -10e6) / 1e6, 1e-6);
            report.compare("column, one step of 1e6 τ: ε_z", "1e-4", -3,
                           liquid.observed("top.z", 1) / 4 * 1e4, 1e-6);
          }};
}

}  // namespace

std::vector<VerifyCase> creep_cases() {
  return {confined_case(), column_case(),   rate_case(),
          shear_case(),    oriented_case(), extremes_case()};
}

}  // namespace faultsim
