#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "simulator/measures/metrics.h"

namespace faultsim {
namespace {

constexpr double kLength = 300, kWidth = 200;  // m along strike and down dip
constexpr double kStrength = 5e6;              // Pa
constexpr double kTolerance = 3e-4;            // m of slip

/// A plane fault of irregular triangles and quadrilaterals of about h metres, oblique in space. Its
/// rim is not split.
class IrregularFault {
 public:
  /// @param numbering  of points, nodes and corners; @param turn  of the axes.
  IrregularFault(double h, unsigned numbering, const Eigen::Matrix3d& turn) : random_(7) {
    strike_ = turn * Eigen::Vector3d(0.6, 0.8, 0);
    dip_ = turn * Eigen::Vector3d(0.8 * 0.5, -0.6 * 0.5, -std::sqrt(0.75));
    const int n = static_cast<int>(std::lround(kLength / h)),
              m = static_cast<int>(std::lround(kWidth / h));
    make_points(n, m, h, numbering);
    make_faces(n, m);
    op.geometry.n_dofs = 2 * static_cast<int>(op.geometry.nodes.size());
    fault_.n_nodes = static_cast<int>(op.geometry.nodes.size());
    fault_.profiles = fault_profiles(fault_, op.geometry.nodes);
    op.geometry.faults = {fault_};
    CoulombLaw law;
    law.static_friction_angle = law.dynamic_friction_angle = std::atan(0.5);
    laws.assign(op.geometry.nodes.size(), law);
    state.jump = state.traction = Eigen::VectorXd::Zero(op.geometry.n_dofs);
    state.slip_path = Eigen::VectorXd::Zero(fault_.n_nodes);
    state.state.assign(laws.size(), FaultState::stick);
    state.cohesion_lost.assign(laws.size(), 0);
  }

  /// χ and slip, as functions of the distance down dip from the upper edge, m.
  template <typename Index, typename Slip>
  FaultMetrics metrics(const Index& critical_index, const Slip& slip, double length = 40) {
    for (std::size_t k = 0; k < laws.size(); ++k) {
      const double v = (op.geometry.nodes[k].position - origin_).dot(dip_);
      state.traction[2 * k] = -2 * kStrength;
      state.traction[2 * k + 1] = kStrength * critical_index(v);
      state.jump[2 * k + 1] = -slip(v);
    }
    const FaultMeter meter(op, laws, kTolerance, length);
    meter.evaluate(state, nodal);
    return meter.measure(nodal, state, Eigen::VectorXd::Zero(op.geometry.n_dofs))[0];
  }
  /// Its profiles further than two faces from the ends along strike, where some samples have but
  /// one split end.
  std::vector<Profile> inner_profiles(double h) const {
    std::vector<Profile> inner;
    for (const Profile& profile : op.geometry.faults[0].profiles) {
      const ProfileSample& sample = profile.samples[profile.samples.size() / 2];
      const double along = (op.geometry.nodes[sample.node[0]].position - origin_).dot(strike_);
      if (along > 3 * h && along < kLength - 3 * h) inner.push_back(profile);
    }
    return inner;
  }
  /// Σ of the widths of its profiles, m.
  double width() const {
    double sum = 0;
    for (const Profile& profile : op.geometry.faults[0].profiles) sum += profile.width;
    return sum;
  }

  FaultOperator op;
  ContactLaws laws;
  ContactState state;
  NodalState nodal;  ///< of the last metrics().

 private:
  void make_points(int n, int m, double h, unsigned numbering) {
    std::vector<int> order((n + 1) * (m + 1));
    std::iota(order.begin(), order.end(), 0);
    std::vector<Eigen::Vector3d> place;
    std::uniform_real_distribution<double> shift(-0.3 * h, 0.3 * h);
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= m; ++j) {
        const double along = shift(random_), down = shift(random_);
        place.push_back(origin_ + (i * h + (i > 0 && i < n ? along : 0)) * strike_ +
                        (j * h + (j > 0 && j < m ? down : 0)) * dip_);
      }
    }
    if (numbering > 0) std::shuffle(order.begin(), order.end(), std::mt19937(numbering));
    turned_ = numbering;
    number_.resize(order.size());
    for (const int grid : order) {
      const int i = grid / (m + 1), j = grid % (m + 1);
      const bool split = i > 0 && j > 0 && i < n && j < m;
      number_[grid] = static_cast<int>(fault_.points.size());
      fault_.points.push_back(place[grid]);
      fault_.node_of_point.push_back(split ? static_cast<int>(op.geometry.nodes.size()) : -1);
      if (!split) continue;
      OperatorNode node;
      node.position = place[grid];
      node.strike = strike_;
      node.dip = dip_;
      const int dof = 2 * static_cast<int>(op.geometry.nodes.size());
      node.dof = {dof, -1, dof + 1};
      node.effective_shear_modulus = 5e9;
      op.geometry.nodes.push_back(node);
    }
  }

  void add_face(std::vector<int> corners) {
    std::rotate(corners.begin(), corners.begin() + turned_ % corners.size(), corners.end());
    if (turned_ % 2 == 1) std::reverse(corners.begin(), corners.end());
    const auto at = [&](std::size_t k) { return fault_.points[corners[k]]; };
    const double area = corners.size() == 3 ? 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm()
                                            : 0.5 * (at(2) - at(0)).cross(at(3) - at(1)).norm();
    for (const int corner : corners) {
      const int node = fault_.node_of_point[corner];
      if (node >= 0) op.geometry.nodes[node].area += area / static_cast<double>(corners.size());
    }
    if (corners.size() == 3) corners.push_back(corners.back());
    fault_.faces.push_back({corners[0], corners[1], corners[2], corners[3]});
  }

  void make_faces(int n, int m) {
    std::uniform_int_distribution<int> kind(0, 2);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < m; ++j) {
        const int a = number_[i * (m + 1) + j], b = number_[i * (m + 1) + j + 1],
                  c = number_[(i + 1) * (m + 1) + j + 1], d = number_[(i + 1) * (m + 1) + j];
        switch (kind(random_)) {
          case 0:
            add_face({a, b, c, d});
            break;
          case 1:
            add_face({a, b, c});
            add_face({a, c, d});
            break;
          default:
            add_face({a, b, d});
            add_face({b, c, d});
        }
      }
    }
  }

  std::mt19937 random_;
  Eigen::Vector3d strike_, dip_, origin_ = {300, -200, -2000};
  std::vector<int> number_;  // of the points of the underlying grid
  unsigned turned_ = 0;      // how corners are ordered
  OperatorFault fault_;
};

const Eigen::Matrix3d kAsItIs = Eigen::Matrix3d::Identity();

double nothing(double) { return 0; }

TEST(FaultSurface, ProfilesCoverAnIrregularFault) {
  for (const double h : {20.0, 10.0, 5.0}) {
    const IrregularFault fault(h, 0, kAsItIs);
    double area = 0, nodes = 0;
    for (const Profile& profile : fault.op.geometry.faults[0].profiles) {
      EXPECT_LE(profile.length(), kWidth + 1e-9);  // less where a face cuts off a corner
      EXPECT_GE(profile.length(), kWidth - 2 * h);
      area += profile.width * (profile.edge.back() - profile.edge.front());
    }
    for (const OperatorNode& node : fault.op.geometry.nodes) nodes += node.area;
    EXPECT_NEAR(fault.width(), kLength - h, 0.4 * h);
    EXPECT_NEAR(area, nodes, 0.005 * h * nodes);
    EXPECT_TRUE(fault.op.geometry.faults[0].profiles.front().strike_edge);
    EXPECT_TRUE(fault.op.geometry.faults[0].profiles.back().strike_edge);
  }
}

TEST(FaultSurface, ThicknessAndAreaOfALinearTractionAreMet) {
  for (const double h : {10.0, 5.0}) {
    IrregularFault fault(h, 0, kAsItIs);
    const auto tent = [](double v) { return 1 - std::abs(v - 110) / 100; };
    const FaultMetrics m = fault.metrics(tent, nothing);
    for (const Profile& profile : fault.inner_profiles(h))  // χ > 0.8 within 20 m of 110 m
      EXPECT_NEAR(length_above(profile, fault.nodal.critical_index, 0.8), 40, 1e-9) << h;
    EXPECT_NEAR(m.thickness_chi_080_max, 40, 0.3 * h) << h;
    EXPECT_NEAR(m.thickness_chi_080_mean, 40, 0.01 * h) << h;
    EXPECT_NEAR(m.area_chi_080, m.thickness_chi_080_mean * fault.width(), 1e-6) << h;
  }
}

TEST(FaultSurface, SlipExtentsOfALinearSlipAreMet) {
  for (const double h : {10.0, 5.0}) {
    IrregularFault fault(h, 0, kAsItIs);
    const double largest = 1e-3, half = 60;
    const auto tent = [&](double v) {
      return largest * std::max(0.0, 1 - std::abs(v - 90) / half);
    };
    const FaultMetrics m = fault.metrics(nothing, tent);
    const double extent = 2 * half * (1 - kTolerance / largest);
    EXPECT_TRUE(m.activated) << h;
    EXPECT_TRUE(m.activation_resolved) << h;
    EXPECT_TRUE(m.activated_at_edge) << h;  // along strike
    EXPECT_NEAR(m.activated_length, extent, 1e-9) << h;
    for (const Profile& profile : fault.inner_profiles(h))
      EXPECT_NEAR(slip_extent(profile, fault.nodal.slip, kTolerance, 40).total, extent, 1e-9) << h;
    EXPECT_NEAR(m.activated_area, extent * fault.width(), 0.001 * h * extent * fault.width()) << h;
    EXPECT_NEAR(m.potency, largest * half * kLength, 0.01 * h * largest * half * kLength);
    EXPECT_FALSE(fault.metrics(nothing, tent, extent + 1).activated) << h;
  }
}

TEST(FaultSurface, WindowIndexMeetsLinearAndLogarithmicTractions) {
  // 0.2 ln(100/|s|) around the middle, means over 2 m: its best window is centred.
  const auto integral = [](double x) {
    return x == 0 ? 0 : 0.2 * x * (std::log(100 / std::abs(x)) + 1);
  };
  const auto peak = [&](double v) { return (integral(v - 100 + 1) - integral(v - 100 - 1)) / 2; };
  const double exact = (integral(20) - integral(-20)) / 40;
  for (const double h : {20.0, 10.0, 5.0, 2.5}) {
    IrregularFault fault(h, 0, kAsItIs);
    const auto tent = [](double v) { return 1 - std::abs(v - 110) / 100; };
    EXPECT_NEAR(fault.metrics(tent, nothing).chi_bar, 0.9, 0.1 * h / 20) << h;
    EXPECT_NEAR(fault.metrics(peak, nothing).chi_bar, exact, 0.02 * h) << h;
  }
}

TEST(FaultSurface, NumberingAndAxesChangeNothing) {
  const auto index = [](double v) { return 0.5 + 0.4 * std::sin(v / 30); };
  const auto slip = [](double v) { return 1e-3 * std::max(0.0, std::sin(v / 40)); };
  IrregularFault reference(10, 0, kAsItIs);
  const FaultMetrics expected = reference.metrics(index, slip);
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()))
                                   .toRotationMatrix();
  for (const unsigned numbering : {0U, 1U, 2U, 7U}) {
    IrregularFault fault(10, numbering, numbering == 1 ? kAsItIs : turn);
    const FaultMetrics m = fault.metrics(index, slip);
    EXPECT_NEAR(m.chi_bar, expected.chi_bar, 1e-9);
    EXPECT_NEAR(m.thickness_chi_080_max, expected.thickness_chi_080_max, 1e-6);
    EXPECT_NEAR(m.thickness_chi_080_mean, expected.thickness_chi_080_mean, 1e-6);
    EXPECT_NEAR(m.area_chi_080, expected.area_chi_080, 1e-3);
    EXPECT_NEAR(m.activated_length, expected.activated_length, 1e-6);
    EXPECT_NEAR(m.activated_area, expected.activated_area, 1e-3);
    EXPECT_NEAR(m.potency, expected.potency, 1e-9);
    EXPECT_EQ(m.activated, expected.activated);
    EXPECT_EQ(m.activation_resolved, expected.activation_resolved);
  }
}

}  // namespace
}  // namespace faultsim
