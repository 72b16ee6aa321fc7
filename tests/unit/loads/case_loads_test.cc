#include "simulator/loads/case_loads.h"

#include <gtest/gtest.h>

#include "tests/unit/measures/faults_between_regions.h"

namespace faultsim {
namespace {

/// Vertical faults across x under a profile: σ_v = −22 kPa/m, p0 = 10 kPa/m, K' = 0.5. The bulk
/// answers to nothing, so what is left is the fluid of the fault.
class FluidInAFault : public testing::Test {
 protected:
  FluidInAFault() {
    at_.scene.faults.resize(2);
    at_.scene.initial.vertical_stress_gradient = -22e3;
    at_.scene.initial.ratio_across = 0.5;
    for (PressureHistory& history : at_.scene.pressure) {
      history.time = {0, 10};
      history.pressure_change = {0, -20e6};
    }
    for (OperatorNode& node : at_.op.geometry.nodes) {
      node.normal = Eigen::Vector3d::UnitX();
      node.strike = -Eigen::Vector3d::UnitY();
      node.dip = -Eigen::Vector3d::UnitZ();
    }
    at_.op.loads.traction = Eigen::MatrixXd::Zero(at_.op.geometry.n_dofs, 2);
  }
  /// t'_N of the locked fault at a node of F1 that lies beside the region west.
  double normal_traction(double fault_biot, double time) {
    at_.scene.faults[0].fault_biot = fault_biot;
    return CaseLoads(at_.scene, at_.op).at(time).locked[2 * kNode];
  }
  static constexpr int kNode = 4;
  static constexpr double kDepth = 2050;
  FaultsBetweenRegions at_;
};

TEST_F(FluidInAFault, CarriesItsBiotShareOfTheInitialPressure) {
  const double p0 = 1e4 * kDepth, effective = 0.5 * (-22e3 * kDepth + p0);
  EXPECT_NEAR(normal_traction(1, 0), effective, 1);
  EXPECT_NEAR(normal_traction(0.6, 0), effective - 0.4 * p0, 1);
  EXPECT_NEAR(normal_traction(0, 0), effective - p0, 1) << "the total stress";
}

TEST_F(FluidInAFault, CarriesItsBiotShareOfTheChange) {
  at_.scene.faults[0].pressure.rule = FaultPressureRule::plus;
  for (const double fault_biot : {1.0, 0.6, 0.0}) {
    const double change = normal_traction(fault_biot, 10) - normal_traction(fault_biot, 0);
    EXPECT_NEAR(change, fault_biot * -20e6, 1) << "depletion presses a fault together";
  }
}

/// A fault begins to slide within a step: the pressures there and then are on the straight line
/// between the ends of the step, also what cells beside it differ by from their regions.
TEST(PressuresWithinAStep, AreOnTheStraightLineBetweenItsEnds) {
  PressureChanges before{{-10e5, 4e5}, Eigen::Vector2d(-8e5, 0)};
  PressureChanges after{{-30e5, 4e5}, Eigen::Vector2d(-16e5, 2e5)};
  before.beside = Eigen::Matrix2d{{1e5, -2e5}, {0, 8e5}};
  after.beside = Eigen::Matrix2d{{5e5, 2e5}, {-4e5, 0}};
  const PressureChanges quarter = between(before, after, 0.25);
  EXPECT_EQ(quarter.pressure_change, (std::vector<double>{-15e5, 4e5}));
  EXPECT_EQ(quarter.fault_pressure_change, Eigen::Vector2d(-10e5, 0.5e5));
  EXPECT_EQ(quarter.beside, (Eigen::Matrix2d{{2e5, -1e5}, {-1e5, 6e5}}));
  EXPECT_EQ(between(before, after, 0).beside, before.beside);
  EXPECT_EQ(between(before, after, 1).beside, after.beside);
}

TEST(PressuresWithinAStep, AreThoseOfRegionsWhereThereIsNoField) {
  const PressureChanges before{{0}, Eigen::Vector2d(0, 0)}, after{{-8e5}, Eigen::Vector2d(0, -4e5)};
  const PressureChanges half = between(before, after, 0.5);
  EXPECT_EQ(half.pressure_change, std::vector<double>{-4e5});
  EXPECT_EQ(half.beside.rows(), 0);
}

}  // namespace
}  // namespace faultsim
