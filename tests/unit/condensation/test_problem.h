#pragma once

#include <string>
#include <vector>

#include "simulator/condensation/condensation.h"
#include "tests/unit/elasticity/test_box.h"

namespace faultsim::test {

inline LoadCase stress_case(const Eigen::Matrix3d& stress, std::vector<BoundaryGroup> sides) {
  LoadCase load;
  load.key = {LoadKey::Kind::boundary, 0};
  load.stress = stress;
  load.stress_groups = std::move(sides);
  return load;
}

inline LoadCase pressure_case(int region) {
  LoadCase load;
  load.key = {LoadKey::Kind::pressure, region, 0};
  load.region = region;
  return load;
}

inline LoadCase displacement_case() {
  LoadCase load;
  load.key = {LoadKey::Kind::boundary, 1};
  load.displacement = true;
  return load;
}

/// The remarks made while building.
class RecordingMonitor final : public Monitor {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string& text) override { notes.push_back(text); }
  std::vector<std::string> notes;
};

inline FaultOperator condense(const BulkProblem& problem) {
  SilentMonitor monitor;
  return CondensedBulk(problem, monitor).condense();
}

/// Sets region and fraction of the cells whose first corner passes.
template <typename Inside>
void set_region(Mesh& mesh, int region, double fraction, const Inside& inside) {
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    if (!inside(mesh.nodes[static_cast<std::size_t>(mesh.cells[cell][0])])) continue;
    mesh.region[cell] = region;
    mesh.region_fraction[cell] = fraction;
  }
}

/// Two materials, an embedded and a through-going fault, rollers and a moving side, two pressure
/// regions, three observation points: something of everything.
inline BulkProblem mixed_problem() {
  const std::array<int, 3> n = {6, 4, 4};
  BulkProblem problem;
  problem.mesh = make_box(n, {60, 40, 40}, {{2, 1, 4, 0, 3}, through(4, n)}, shear_to_dip(70));
  distort(problem.mesh, 10, 0.05);
  problem.materials = {{11e9, 0.15}, {40e9, 0.3}};
  for (std::size_t cell = 0; cell < problem.mesh.cells.size(); ++cell) {
    if (problem.mesh.nodes[static_cast<std::size_t>(problem.mesh.cells[cell][0])].z() > -15) {
      problem.mesh.material[cell] = 1;
    }
  }
  set_region(problem.mesh, 0, 1, [](const auto& x) { return x.z() < -5 && x.y() > 5; });
  set_region(problem.mesh, 1, 0.25, [](const auto& x) { return x.x() < 15 && x.y() <= 5; });
  problem.conditions = rollers({Side::x_min, Side::y_min, Side::z_min});
  problem.conditions.push_back({Side::x_max,
                                {true, true, false},
                                Eigen::Vector3d(-1e-3, 2e-3, 0),
                                Eigen::Matrix3d::Constant(1e-5),
                                2});
  Eigen::Matrix3d stress;
  stress << -20, 3, 2, 3, -25, 1, 2, 1, -30;
  problem.loads = {pressure_case(0), stress_case(1e6 * stress, {Side::z_max}), displacement_case(),
                   pressure_case(1)};
  problem.observation_points = {
      {"top", {30, 20, 1}}, {"fault", {20, 20, -20}}, {"corner", {60, 0, 0}}};
  return problem;
}

}  // namespace faultsim::test
