#include "simulator/loading/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace faultsim {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A plane-strain fault with n nodes every h metres between two unsplit tips.
struct LineFault {
  LineFault(int n, double h, bool half = false) {
    OperatorFault fault;
    fault.name = "F";
    fault.n_columns = 1;
    fault.n_rows = n + 2;
    fault.column_width = {1.0};
    fault.n_nodes = n;
    for (int row = 0; row < n + 2; ++row) {
      fault.grid_position.emplace_back(0, 0, -h * row);
      fault.grid_node.push_back(row == 0 || row == n + 1 ? -1 : row - 1);
      fault.grid_used.push_back(1);
    }
    for (int k = 0; k < n; ++k) {
      OperatorNode node;
      node.area = h;
      node.dof = {2 * k, -1, 2 * k + 1};
      node.effective_shear_modulus = 5e9;
      op.geometry.nodes.push_back(node);
    }
    op.geometry.n_dofs = 2 * n;
    op.geometry.faults = {fault};
    op.geometry.half_domain = half;
    CoulombLaw law;
    law.static_friction_angle = law.dynamic_friction_angle = std::atan(0.5);
    laws.node.assign(static_cast<std::size_t>(n), law);
    laws.cumulated.assign(static_cast<std::size_t>(n), 0);
    laws.keep_cohesion.assign(static_cast<std::size_t>(n), 0);
    state.jump = state.traction = Eigen::VectorXd::Zero(2 * n);
    state.slip_path = Eigen::VectorXd::Zero(n);
    state.state.assign(static_cast<std::size_t>(n), FaultState::stick);
    state.cohesion_lost.assign(static_cast<std::size_t>(n), 0);
    for (int k = 0; k < n; ++k) state.traction[2 * k] = -10e6;
  }
  FaultOperator op;
  ContactLaws laws;
  ContactState state;
};

TEST(FaultMeter, CriticalIndexIsShearOverStrengthAndOneWhereOpen) {
  LineFault f(3, 10);
  f.state.traction[1] = -4e6;  // strength 5 MPa
  f.state.state[1] = FaultState::open;
  f.state.traction[2] = f.state.traction[3] = 0;
  const FaultMeter meter(f.op, f.laws, 1e-4, 40);
  NodalState nodal;
  meter.evaluate(f.state, nodal);
  EXPECT_NEAR(nodal.critical_index[0], 0.8, 1e-12);
  EXPECT_EQ(nodal.critical_index[1], 1.0);
  EXPECT_EQ(nodal.critical_index[2], 0.0);
  const auto m = meter.measure(nodal, f.state, f.state.jump);
  EXPECT_DOUBLE_EQ(m[0].open_area, 10.0);
  EXPECT_EQ(m[0].chi_max, 1.0);
}

TEST(FaultMeter, WindowIndexOfALinearLoadIsTheMeanOfItsMostLoadedWindow) {
  for (const double h : {10.0, 5.0, 2.5}) {
    const int n = static_cast<int>(200 / h) - 1;
    LineFault f(n, h);
    for (int k = 0; k < n; ++k) f.state.traction[2 * k + 1] = 2.5e6 * ((k + 1) * h) / 200;
    const FaultMeter meter(f.op, f.laws, 1e-4, 40);
    NodalState nodal;
    meter.evaluate(f.state, nodal);
    // The window at the loaded end has 0.9 of the end value 0.5, less the constant end half cell.
    EXPECT_NEAR(window_critical_index(meter.columns()[0], nodal, 40), 0.45, 0.5 * h / 200) << h;
  }
}

TEST(FaultMeter, WindowIndexDoesNotGrowWithALogarithmicPeakAsCellsShrink) {
  double coarse_window = 0, coarse_peak = 0, fine_window = 0, fine_peak = 0;
  for (const double h : {10.0, 1.25}) {
    const int n = static_cast<int>(200 / h) - 1;
    LineFault f(n, h);
    for (int k = 0; k < n; ++k) {
      const double s = std::max(std::abs((k + 1) * h - 100), h / 2);
      f.state.traction[2 * k + 1] = 0.5e6 * std::log(200 / s);
    }
    const FaultMeter meter(f.op, f.laws, 1e-4, 40);
    NodalState nodal;
    meter.evaluate(f.state, nodal);
    (h > 5 ? coarse_window : fine_window) = window_critical_index(meter.columns()[0], nodal, 40);
    (h > 5 ? coarse_peak : fine_peak) = nodal.critical_index.maxCoeff();
  }
  EXPECT_NEAR(fine_window, coarse_window, 0.1 * fine_window);
  EXPECT_GT(fine_peak, 1.4 * coarse_peak);
}

TEST(FaultMeter, LengthAboveIsLocatedByInterpolation) {
  LineFault f(9, 10);
  for (int k = 0; k < 9; ++k) f.state.traction[2 * k + 1] = 5e6 * (k == 4 ? 1.0 : 0.0);
  const FaultMeter meter(f.op, f.laws, 1e-4, 40);
  NodalState nodal;
  meter.evaluate(f.state, nodal);
  EXPECT_NEAR(length_above(meter.columns()[0], nodal.critical_index, 0.8), 4.0, 1e-12);
  nodal.critical_index.setOnes();
  EXPECT_NEAR(length_above(meter.columns()[0], nodal.critical_index, 0.8), 90.0, 1e-12);
}

TEST(FaultMeter, ActivationNeedsTheLengthNotTheNumberOfCells) {
  for (const double h : {20.0, 10.0, 2.5}) {
    const int n = static_cast<int>(200 / h) - 1;
    LineFault f(n, h);
    const auto tent = [&](double half_width) {  // slip of 1 mm at the centre, 0 at ± half_width
      for (int k = 0; k < n; ++k) {
        f.state.jump[2 * k + 1] =
            -1e-3 * std::max(0.0, 1 - std::abs((k + 1) * h - 100) / half_width);
      }
    };
    const FaultMeter meter(f.op, f.laws, 1e-4, 40);
    tent(20 / 0.9 - 2);
    EXPECT_FALSE(meter.activation(f.state, nullptr)[0].activated) << h;
    tent(60);
    const auto a = meter.activation(f.state, nullptr)[0];
    EXPECT_TRUE(a.activated) << h;
    EXPECT_NEAR(a.length, 108.0, h == 20.0 ? 2.0 : 1e-9) << h;
    EXPECT_NEAR(a.area, a.length, 1e-9);
    EXPECT_NEAR(a.max_slip, 1e-3, 1e-12);
  }
}

TEST(FaultMeter, ActivationOfAStageCountsSlipSinceItsStart) {
  LineFault f(19, 10);
  for (int k = 0; k < 19; ++k) f.state.jump[2 * k + 1] = 5e-3;
  const Eigen::VectorXd start = f.state.jump;
  const FaultMeter meter(f.op, f.laws, 1e-4, 40);
  EXPECT_TRUE(meter.activation(f.state, nullptr)[0].activated);
  EXPECT_FALSE(meter.activation(f.state, &start)[0].activated);
}

TEST(FaultMeter, MomentAndPotencyAreDoubledForAHalfDomain) {
  LineFault full(3, 10), half(3, 10, true);
  for (LineFault* f : {&full, &half}) {
    for (int k = 0; k < 3; ++k) f->state.jump[2 * k + 1] = 1e-3;
  }
  NodalState nodal;
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(6);
  const FaultMeter a(full.op, full.laws, 1e-4, 40), b(half.op, half.laws, 1e-4, 40);
  a.evaluate(full.state, nodal);
  const FaultMetrics m = a.measure(nodal, full.state, zero)[0],
                     m2 = b.measure(nodal, half.state, zero)[0];
  EXPECT_DOUBLE_EQ(m.potency, 0.03);
  EXPECT_DOUBLE_EQ(m.moment, 0.03 * 5e9);
  EXPECT_DOUBLE_EQ(m.moment_step, m.moment);
  EXPECT_DOUBLE_EQ(m2.moment, 2 * m.moment);
  EXPECT_DOUBLE_EQ(m2.mean_slip, m.mean_slip);
}

TEST(FaultMeter, IgnoresWhatMustNotTakePart) {
  LineFault f(5, 10);
  f.laws.node[2].slip_weakening_distance = kNaN;  // no weakening: d_c plays no role
  f.state.slip_path.setConstant(kNaN);
  const FaultMeter meter(f.op, f.laws, 1e-4, 40);
  NodalState nodal;
  meter.evaluate(f.state, nodal);
  EXPECT_TRUE(nodal.critical_index.allFinite());
  EXPECT_TRUE(nodal.strength.allFinite());
}

}  // namespace
}  // namespace faultsim
