#include "simulator/measures/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace faultsim {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<double> even(int n, double h) {
  std::vector<double> s;
  for (int k = 0; k < n; ++k) s.push_back(h * k);
  return s;
}

/// A plane-strain fault with nodes at s metres down dip, the first and last of which are unsplit.
struct LineFault {
  explicit LineFault(const std::vector<double>& s, bool half = false) {
    const int n = static_cast<int>(s.size()) - 2;
    OperatorFault fault;
    fault.name = "F";
    fault.n_nodes = n;
    for (int row = 0; row < n + 2; ++row) {
      fault.points.emplace_back(0, 0, -s[row]);
      fault.node_of_point.push_back(row == 0 || row == n + 1 ? -1 : row - 1);
      if (row > 0) fault.faces.push_back({row - 1, row, row, row - 1});
    }
    for (int k = 0; k < n; ++k) {
      OperatorNode node;
      node.strike = Eigen::Vector3d::UnitY();
      node.dip = -Eigen::Vector3d::UnitZ();
      node.area = (s[k + 2] - s[k]) / 2;
      node.dof = {2 * k, -1, 2 * k + 1};
      node.effective_shear_modulus = 5e9;
      op.geometry.nodes.push_back(node);
    }
    op.geometry.n_dofs = 2 * n;
    fault.profiles = fault_profiles(fault, op.geometry.nodes);
    op.geometry.faults = {fault};
    op.geometry.half_domain = half;
    CoulombLaw law;
    law.static_friction_angle = law.dynamic_friction_angle = std::atan(0.5);
    laws.assign(n, law);
    state.jump = state.traction = Eigen::VectorXd::Zero(2 * n);
    state.slip_path = Eigen::VectorXd::Zero(n);
    state.state.assign(n, FaultState::stick);
    state.cohesion_lost.assign(n, 0);
    for (int k = 0; k < n; ++k) state.traction[2 * k] = -10e6;
  }
  /// n nodes every h metres between two unsplit tips.
  LineFault(int n, double h, bool half = false) : LineFault(even(n + 2, h), half) {}

  const Profile& profile() const { return op.geometry.faults[0].profiles[0]; }
  int n() const { return static_cast<int>(op.geometry.nodes.size()); }
  void slip(int first, int last, double by) {
    for (int k = first; k <= last; ++k) state.jump[2 * k + 1] = by;
  }
  /// χ of every node, of a strength of 5 MPa.
  void load(double critical_index) {
    for (int k = 0; k < n(); ++k) state.traction[2 * k + 1] = 5e6 * critical_index;
  }
  FaultMeter meter(double length = 40) const { return FaultMeter(op, laws, 1e-4, length); }
  NodalState nodal() const {
    NodalState nodal;
    meter().evaluate(state, nodal);
    return nodal;
  }
  Activation activation(const Eigen::VectorXd& reference = {}) const {
    return meter().activation(0, nodal(), state, reference);
  }
  double window_index(double length = 40) const {
    const NodalState values = nodal();
    return WindowSearch(profile(), length)
        .most_loaded(values.shear, values.strength)
        .critical_index;
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
    // The last window of whole dual cells ends half a cell before the tip at 200 m.
    EXPECT_NEAR(f.window_index(), 0.5 * (180 - h / 2) / 200, 1e-12) << h;
  }
}

TEST(FaultMeter, WindowIndexIsAQuotientOfForcesWhateverTheCells) {
  // Nodes 1 to 6 have dual cells of 6, 7.5, 10, 15, 22.5 and 20 m and strengths of 5, 10, 15, 5, 5
  // and 5 MPa. The best window has all of the third and the fourth and the first 15 m of the fifth,
  // which is sloped towards the sixth, 21.25 m away, by 1 MPa.
  LineFault f({0, 4, 12, 19, 32, 49, 77, 89});
  const double chi[] = {0.1, 0.2, 0.9, 0.8, 0.3, 0.1};
  const double normal[] = {-10e6, -20e6, -30e6, -10e6, -10e6, -10e6};
  for (int k = 0; k < 6; ++k) {
    f.state.traction[2 * k] = normal[k];
    f.state.traction[2 * k + 1] = -0.5 * normal[k] * chi[k];
  }
  const double fifth = 1.5 + (22.5 - 15) / 2 / 21.25;
  EXPECT_NEAR(f.window_index(), (10 * 13.5 + 15 * 4 + 15 * fifth) / (10 * 15 + 15 * 5 + 15 * 5),
              1e-12);
  f.load(0.35);
  for (int k = 0; k < 6; ++k) f.state.traction[2 * k] = -10e6;
  EXPECT_NEAR(f.window_index(), 0.35, 1e-12);
  EXPECT_NEAR(f.window_index(500), 0.35, 1e-12);  // longer than the fault: all of it
}

TEST(FaultMeter, WindowIndexOfALogarithmicPeakIsItsIntegralOnAnyCells) {
  // χ = 0.2 ln(100 m/|s − 100 m|), by the force on each node; its best window is centred.
  const auto antiderivative = [](double x) {
    return x == 0 ? 0 : 0.2 * x * (std::log(100 / std::abs(x)) + 1);
  };
  const double exact = (antiderivative(20) - antiderivative(-20)) / 40;
  const auto with_forces = [&](const std::vector<double>& s) {
    LineFault f(s);
    for (int k = 0; k < f.n(); ++k) {
      const double low = (s[k] + s[k + 1]) / 2 - 100, high = (s[k + 1] + s[k + 2]) / 2 - 100;
      f.state.traction[2 * k + 1] =
          5e6 * (antiderivative(high) - antiderivative(low)) / (high - low);
    }
    return f.window_index();
  };
  std::vector<double> cells_of_8;
  for (int k = -12; k <= 12; ++k) cells_of_8.push_back(100 + 8 * k);
  // Dual cells that end at 80 and 120 m, ...
  EXPECT_NEAR(with_forces(cells_of_8), exact, 1e-12);
  EXPECT_NEAR(with_forces({0, 50, 74, 86, 94, 100, 106, 114, 126, 150, 200}), exact, 1e-12);
  // ... and such that the window cuts.
  EXPECT_NEAR(with_forces(even(81, 2.5)), exact, 0.002);
  EXPECT_NEAR(with_forces(even(41, 5)), exact, 0.006);
  EXPECT_NEAR(with_forces(even(11, 20)), exact, 0.03);
}

TEST(FaultMeter, WindowIndexIsAtMostTheLargestNodalIndex) {
  // The first two of 20 m slip. The window cuts the second, where shear is sloped down to the third
  // and strength, least here, is not.
  LineFault f(7, 20);
  f.load(0.1);
  const double normal[] = {-14e6, -12e6, -16e6}, shear[] = {7e6, 6e6, 1e6};
  for (int k = 0; k < 3; ++k) {
    f.state.traction[2 * k] = normal[k];
    f.state.traction[2 * k + 1] = shear[k];
  }
  EXPECT_NEAR(f.window_index(30), 1, 1e-12);
}

TEST(FaultMeter, WindowIndexIsTheSameUpsideDown) {
  const std::vector<double> s = {0, 4, 12, 19, 32, 49, 77, 89},
                            back = {0, 12, 40, 57, 70, 77, 85, 89};
  LineFault down(s), up(back);
  for (int k = 0; k < down.n(); ++k) {
    down.state.traction[2 * k + 1] = 1e6 * (k * k % 5);
    up.state.traction[2 * (up.n() - 1 - k) + 1] = -1e6 * (k * k % 5);
  }
  EXPECT_NEAR(down.window_index(), up.window_index(), 1e-12);
}

TEST(FaultMeter, LengthAboveIsLocatedByInterpolation) {
  LineFault f(9, 10);
  for (int k = 0; k < 9; ++k) f.state.traction[2 * k + 1] = 5e6 * (k == 4 ? 1.0 : 0.0);
  NodalState nodal = f.nodal();
  EXPECT_NEAR(length_above(f.profile(), nodal.critical_index, 0.8), 4.0, 1e-12);
  nodal.critical_index.setOnes();
  EXPECT_NEAR(length_above(f.profile(), nodal.critical_index, 0.8), 90.0, 1e-12);
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
    tent(20 / 0.9 - 2);
    EXPECT_FALSE(f.activation().activated) << h;
    tent(60);
    const auto a = f.activation();
    EXPECT_TRUE(a.activated) << h;
    EXPECT_TRUE(a.resolved) << h;
    EXPECT_NEAR(a.length, 108.0, h == 20.0 ? 2.0 : 1e-9) << h;
    EXPECT_NEAR(a.area, a.length, 1e-9);
    EXPECT_NEAR(a.max_slip, 1e-3, 1e-12);
  }
}

TEST(FaultMeter, ActivationOfAStageCountsSlipSinceItsStart) {
  LineFault f(19, 10);
  f.slip(0, 18, 5e-3);
  const Eigen::VectorXd start = f.state.jump;
  EXPECT_TRUE(f.activation().activated);
  EXPECT_FALSE(f.activation(start).activated);
}

TEST(FaultMeter, AFlagFromTooFewCellsIsNotResolved) {
  LineFault coarse(9, 50);
  coarse.slip(4, 4, 1e-2);  // one node: 99 m by interpolation, anything in truth
  EXPECT_TRUE(coarse.activation().activated);
  EXPECT_FALSE(coarse.activation().resolved);
  coarse.slip(3, 6, 1e-2);  // 3 cells
  EXPECT_FALSE(coarse.activation().resolved);
  coarse.slip(3, 7, 1e-2);  // 4 cells
  EXPECT_TRUE(coarse.activation().resolved);
  LineFault fine(79, 2.5);
  fine.slip(20, 36, 1e-2);  // 40 m of whole cells, up to 45
  EXPECT_TRUE(fine.activation().resolved);
}

TEST(FaultMeter, AFlagIsResolvedUnlessItHangsOnWhereInACellSlipEnds) {
  LineFault f(39, 10);
  f.slip(10, 13, 2e-4);  // 30 m, and half of a cell on either side: 40 ± 10
  EXPECT_TRUE(f.activation().activated);
  EXPECT_FALSE(f.activation().resolved);
  f.slip(10, 13, 1.6e-4);  // 37.5 ± 10
  EXPECT_FALSE(f.activation().activated);
  EXPECT_FALSE(f.activation().resolved);
  f.slip(13, 13, 0);  // 27.5 ± 10
  EXPECT_TRUE(f.activation().resolved);
  f.slip(10, 14, 2e-4);  // 50 ± 10
  EXPECT_TRUE(f.activation().resolved);
  f.slip(20, 22, 1.9e-4);  // another stretch that may or may not
  EXPECT_TRUE(f.activation().resolved);
}

TEST(FaultMeter, AFaultNearActivationIsNotResolvedWithoutSlip) {
  for (const auto& [h, near] : {std::pair{50.0, 0.76}, std::pair{10.0, 0.951}}) {
    LineFault f(39, h);
    f.load(near - 0.02);
    EXPECT_TRUE(f.activation().resolved) << h;
    f.load(near);
    EXPECT_FALSE(f.activation().activated);
    EXPECT_FALSE(f.activation().resolved) << h;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(2 * f.n());
    const FaultMetrics m = f.meter().measure(f.nodal(), f.state, zero)[0];
    EXPECT_FALSE(m.activated);
    EXPECT_FALSE(m.activation_resolved);
    f.slip(5, 30, 1e-2);  // it slid before: the cells can tell, and in this stage it does not
    EXPECT_TRUE(f.activation(f.state.jump).resolved) << h;
  }
  LineFault little(3, 5);  // 20 m: it cannot be activated
  little.load(1);
  EXPECT_TRUE(little.activation().resolved);
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
  f.laws[2].slip_weakening_distance = kNaN;  // no weakening: d_c plays no role
  f.state.slip_path.setConstant(kNaN);
  const FaultMeter meter(f.op, f.laws, 1e-4, 40);
  NodalState nodal;
  meter.evaluate(f.state, nodal);
  EXPECT_TRUE(nodal.critical_index.allFinite());
  EXPECT_TRUE(nodal.strength.allFinite());
}

}  // namespace
}  // namespace faultsim
