// The closed forms of friction against the numbers printed with them.
#include "tests/verification/closed_forms/friction_solutions.h"
#include "simulator/common/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

TEST(InitialCriticalIndex, MatchesTheTable) {
  const double dips[] = {0, 5, 10, 15, 20, 25};
  const double mild[] = {0, 0.0527, 0.1030, 0.1486, 0.1879, 0.2193};
  const double strong[] = {0, 0.2230, 0.4251, 0.5902, 0.7104, 0.7849};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(initial_critical_index(0.74, dips[i] * kDegree, 30 * kDegree), mild[i], 5.1e-5);
    EXPECT_NEAR(initial_critical_index(0.40, dips[i] * kDegree, 30 * kDegree), strong[i], 5.1e-5);
  }
}

TEST(CriticalDepletion, MatchesThePrintedOnset) {
  const UniformDepletion state{28e6, 0.74 * 28e6, 25 * kDegree, 30 * kDegree, 1, 1, 0.15};
  const FaultLoad start = fault_load(state, 0);
  EXPECT_NEAR(start.normal / 1e6, 22.020253, 1e-6);
  EXPECT_NEAR(start.shear / 1e6, 2.788402, 1e-6);
  EXPECT_NEAR(critical_depletion(state) / 1e6, 77.1630, 1e-4);
  const FaultLoad onset = fault_load(state, -critical_depletion(state));
  EXPECT_NEAR(onset.shear, onset.normal * std::tan(state.friction_angle), 1e-3);
}

Slider linear_slider(double distance) {
  return {10e6, 20e6, std::atan(0.6), std::atan(0.4), distance, false};
}

TEST(Slider, FollowsTheLinearLaw) {
  const double u[] = {1.2, 1.3, 1.4, 1.5, 1.6, 1.8};
  const double slip[] = {0, 0.2, 0.4, 0.6, 0.8, 1.0};
  const double shear[] = {12, 11, 10, 9, 8, 8};
  for (int i = 0; i < 6; ++i) {
    const double d = slider_slip(linear_slider(0.8), u[i]);
    EXPECT_NEAR(d, slip[i], 1e-12);
    EXPECT_NEAR(10 * (u[i] - d), shear[i], 1e-11);
  }
}

TEST(Slider, FollowsTheAngleLaw) {
  Slider slider{10e6, 20e6, 30 * kDegree, 10 * kDegree, 1.6, true};
  EXPECT_NEAR(slider_onset(slider), 1.15470054, 1e-8);
  EXPECT_NEAR(slider_critical_distance(slider), 0.93084227, 1e-8);
  EXPECT_EQ(slider_slip(slider, 1.15), 0);
  EXPECT_NEAR(slider_slip(slider, 1.2), 0.1063831, 1e-7);
  EXPECT_NEAR(slider_slip(slider, 1.5), 0.7445245, 1e-7);
  EXPECT_NEAR(slider_slip(slider, 1.7), 1.13232449, 1e-8);
  EXPECT_NEAR(slider_slip(slider, 1.9), 1.50398049, 1e-8);
  EXPECT_NEAR(slider_slip(slider, 2.1), 1.74734604, 1e-8);
}

TEST(SliderPath, DissipatesThePrintedEnergyPerCycle) {
  const Slider slider{10e6, 20e6, std::atan(0.6), std::atan(0.6), 1, false};
  const SliderPath path = slider_path(slider, {1.2, 2, -0.4, -2, 2});
  const double expected[] = {0, 0.8, 0.8, -0.8, 0.8};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(path.slip[i], expected[i], 1e-12);
  const double first_loading = 0.8 * 12e6;
  EXPECT_NEAR((path.dissipated - first_loading) / 1e6, 38.4, 1e-9);
}

TEST(ConeResidual, VanishesForTheSolutionAndNotBesideIt) {
  const Eigen::MatrixXd w = Eigen::MatrixXd::Identity(9, 9);
  Eigen::VectorXd q(9), r(9);
  q << -1, 1, 3, -1, 1, 3, -1, 1, 3;
  for (int k = 0; k < 9; k += 3) {
    r[k] = 1;
    r.segment<2>(k + 1) = -0.1 * q.segment<2>(k + 1).normalized();
  }
  EXPECT_NEAR(cone_residual(w, q, 0.1, r), 0, 1e-14);
  EXPECT_NEAR((w * r + q).norm(), 5.30402049429, 1e-10);
  r[0] = 1.01;
  EXPECT_GT(cone_residual(w, q, 0.1, r), 1e-3);
}

}  // namespace
}  // namespace faultsim
