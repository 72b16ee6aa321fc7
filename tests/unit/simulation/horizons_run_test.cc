#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/simulation/loaded_scene.h"

/// Scenes whose body is built of horizons, from the scene to its result.
namespace faultsim {
namespace {

constexpr const char* kLayer = R"({
  "format": 1,
  "materials": {
    "shale": { "youngs_modulus": "15 GPa", "poisson_ratio": 0.25 },
    "sand": { "youngs_modulus": "11 GPa", "poisson_ratio": 0.15 }
  },
  "geometry": {
    "kind": "horizons",
    "from": ["-2 km", "-2 km"], "to": ["2 km", "2 km"], "depth": "4 km", "trace_depth": "2 km",
    "layers": [
      { "name": "cover", "material": "shale", "top": "0 m" },
      { "name": "reservoir", "material": "sand", "top": "1800 m" },
      { "name": "base", "material": "shale", "top": "2200 m" }
    ],
    "compartments": [ { "name": "all", "inside": ["-1500 m", "0 m"], "layers": ["reservoir"] } ]
  },
  "mesh": { "strike": "150 m" },
  "initial_state": { "kind": "profile", "vertical_stress_gradient": "-23 kPa/m", "pressure_gradient": "10 kPa/m" },
  "friction": { "friction_angle": "60 deg" },
  "faults": [
    { "name": "F1", "trace": [["-100 m", "-1200 m"], ["0 m", "0 m"], ["50 m", "1300 m"]],
      "dip_from_vertical": ["10 deg", "35 deg", "-15 deg"], "top": "1500 m", "bottom": "2500 m", "throw": "0 m" }
  ],
  "stages": [ { "name": "production", "duration": "20 years", "steps": 2, "pressure_change": "-150 bar" } ]
})";

/// A confined layer that is depleted by Δp: horizontal stresses rise by γ_h |Δp|, γ_h = (1 − 2ν)/(1
/// − ν), the vertical one stays; on a fault whose dip changes along it the traction is that of its
/// own normal at each place.
TEST(HorizonsRun, OnAFaultWhoseDipChangesTractionsAreThoseOfItsNormals) {
  const Scene scene = read_scene(parse_json(kLayer, "layer.json"));
  std::vector<Problem> problems;
  const Plan plan = make_plan(scene, problems);
  ASSERT_TRUE(problems.empty());
  SilentMonitor monitor;
  const PreparedOperator prepared = prepare_operator(scene, plan, {}, false, monitor);
  std::vector<FaultFields> steps;
  const auto keep = [&](const StepResult&, const FaultFields& step) { steps.push_back(step); };
  const CaseResult result = run_case(scene, prepared, monitor, {{keep}});
  ASSERT_EQ(result.outcome, Outcome::converged) << result.reason;
  const double rise = 0.7 / 0.85 * 15e6;
  constexpr double kClose = 0.01;  // a node's normal is the mean of its facets'
  double least = 1, most = -1;
  int n = 0;
  const auto& nodes = prepared.op->geometry.nodes;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double z = nodes[k].position.z();
    if (std::abs(std::abs(z + 2000) - 200) < 1) continue;  // where the layer ends
    const double here = std::abs(z + 2000) < 200 ? rise : 0;
    const auto column = static_cast<Eigen::Index>(k);
    const Eigen::Vector3d change =
        steps.back().traction.col(column) - steps.front().traction.col(column);
    const Eigen::Vector3d normal = nodes[k].normal;
    const Eigen::Vector3d expected(here * normal.x(), here * normal.y(), 0);
    const double pressure = here > 0 ? -15e6 : 0;  // what is held is the effective traction
    EXPECT_NEAR(change[0], expected.dot(normal) + pressure, kClose * rise)
        << nodes[k].position.transpose();
    EXPECT_NEAR(change[1], expected.dot(nodes[k].strike), kClose * rise);
    EXPECT_NEAR(change[2], expected.dot(nodes[k].dip), kClose * rise);
    if (here == 0) continue;
    least = std::min(least, normal.z());
    most = std::max(most, normal.z());
    ++n;
  }
  EXPECT_GT(n, 20);
  EXPECT_GT(most, std::sin(30 * std::numbers::pi / 180)) << "leans by up to 35 degrees";
  EXPECT_LT(least, -0.15) << "and to the other side";
}

}  // namespace
}  // namespace faultsim
