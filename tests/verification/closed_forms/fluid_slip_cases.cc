// V11: slip driven by fluid that diffuses along a fault of constant friction.
#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/common/errors.h"
#include "tests/verification/closed_forms/verify_cases.h"

namespace faultsim {
namespace {

const char kFluidSlip[] = "v11_fluid_driven_slip.json";
constexpr double kFriction = 0.6, kNormal = 60e6, kOverpressure = 30e6;  // Pa, of the scene
constexpr double kDepth = 5000;                                          // m, of the injection
constexpr double kHalfLength = 100;                                      // m, a at the end
constexpr int kTimes = 8;  // steps; a grows linearly from one to the next

/// λ = a/√(4αt) at T = (f N0 − τ0)/(f Δp): table of Viesca, J. Fluid Mech. 928 (2021).
struct Solution {
  double stress_parameter, growth;
};
constexpr Solution kSolutions[] = {{0.1, 3.64052}, {0.4, 1.02524}, {0.9, 0.13981}};
constexpr double kCentreSlip = 0.2685475;  ///< δ(0) μ'/(a f Δp) at T = 0.4, the same source.

/// A line of Δp_f = Δp erfc(|x|/√(4αt)) at time 0 and the ends of the steps, where √(4αt) grows to
/// `reach`.
std::string table_line(double x, double reach) {
  std::string line = concat(kDepth + x, ", 0");
  for (int k = 1; k <= kTimes; ++k)
    line += concat(", ", kOverpressure * std::erfc(std::abs(x) / (reach * k / kTimes)));
  return line;
}

/// The pressures as the scene's table: points close together at the injection, √t ∝ step.
std::string table_json(double reach) {
  std::string header = "depth [m], 0 year [Pa]";
  for (int k = 1; k <= kTimes; ++k) header += concat(", ", k * k, " year [Pa]");
  std::string lines = "[\"" + header + "\"";
  constexpr int kPoints = 200;
  constexpr double kNearest = 1e-3, kFarthest = 4.5;  // of the reach
  std::vector<double> places = {0};
  for (int i = 0; i <= kPoints; ++i) {
    const double x = reach * kNearest * std::pow(kFarthest / kNearest, double{1} * i / kPoints);
    places.insert(places.end(), {x, -x});
  }
  for (const double x : places) lines += ",\"" + table_line(x, reach) + "\"";
  return lines + "]";
}

Settings settings_of(const Solution& solution, double cell) {
  const double reach = kHalfLength / solution.growth;
  const double shear = kFriction * (kNormal - solution.stress_parameter * kOverpressure);
  const double box = 30 * std::max(reach, kHalfLength);
  const auto corner = [&](double x, double y) {
    return concat("[\"", x, " m\",\"", y, " m\",\"", x - kDepth, " m\"]");
  };
  const std::string n = concat("\"", -kNormal, " Pa\""), t = concat("\"", shear, " Pa\"");
  return {{"/tables/fault_pressure.csv", table_json(reach)},
          {"/geometry/from", corner(-box, -1)},
          {"/geometry/to", corner(box, 1)},
          {"/mesh/dip", concat(cell, " m")},
          {"/mesh/normal", concat(cell, " m")},
          {"/initial_state/tensor", concat("[[", n, ",\"0 Pa\",", t, "],[\"0 Pa\",", n,
                                           ",\"0 Pa\"],[", t, ",\"0 Pa\",", n, "]]")}};
}

struct Slip {
  double half_length = 0;  ///< m: from the last nodes that slip, δ^(2/3) being linear near the tip.
  double centre = 0;       ///< m.
};

/// Slip along one line of nodes at a step, from the injection upwards.
Slip slip_at(const SceneRun& run, std::size_t step) {
  std::vector<std::pair<double, double>> line;  // distance from the injection, slip
  for (std::size_t k = 0; k < run.geometry().nodes.size(); ++k) {
    const double x = run.geometry().nodes[k].position.z() + kDepth;
    const auto jump = run.fields[step].jump.col(static_cast<Eigen::Index>(k));
    if (x >= -1e-6) line.emplace_back(x, jump.tail<2>().norm());
  }
  std::sort(line.begin(), line.end());
  Slip slip;
  slip.centre = line.front().second;
  std::size_t last = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i].second > 1e-9) last = i;
  }
  FAULTSIM_DEMAND(last >= 4 && last + 1 < line.size(), "the slip ends within the fault");
  const auto& [x1, d1] = line[last - 3];
  const auto& [x2, d2] = line[last - 1];
  const double y1 = std::pow(d1, 2.0 / 3), y2 = std::pow(d2, 2.0 / 3);
  slip.half_length = x2 + y2 * (x2 - x1) / (y1 - y2);
  return slip;
}

void compare(const Solution& solution, double cell, SceneRunner& runner, VerifyReport& report) {
  const SceneRun run = runner.run(kFluidSlip, settings_of(solution, cell));
  const Material& rock = run.scene.materials.front();
  const double modulus = rock.youngs_modulus / (2 * (1 + rock.poisson_ratio));
  const double stiffness = modulus / (2 * (1 - rock.poisson_ratio));
  for (const int step : {kTimes / 2, kTimes}) {
    const double exact = kHalfLength * step / kTimes;
    const Slip slip = slip_at(run, static_cast<std::size_t>(step));
    const std::string what = concat("T = ", short_number(solution.stress_parameter), ", cells of ",
                                    short_number(cell), " m, t = ", step * step, " year: ");
    report.compare(what + "λ = a/√(4αt)", "", solution.growth,
                   solution.growth * slip.half_length / exact, 0.01);
    if (solution.stress_parameter != 0.4) continue;
    report.compare(what + "slip at the centre", "m",
                   kCentreSlip * exact * kFriction * kOverpressure / stiffness, slip.centre, 0.02);
  }
}

}  // namespace

std::vector<VerifyCase> fluid_slip_cases() {
  return {{"V11-fluid",
           "fluid-driven slip, constant friction: growth and slip, two sizes and two times",
           {kFluidSlip},
           false,
           [](SceneRunner& runner, VerifyReport& report) {
             for (const Solution& solution : kSolutions) {
               for (const double cell : {2.0, 1.0}) compare(solution, cell, runner, report);
             }
           }}};
}

}  // namespace faultsim
