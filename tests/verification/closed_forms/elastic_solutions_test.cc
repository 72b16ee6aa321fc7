// The closed forms against the numbers printed in the literature they are taken from.
#include "tests/verification/closed_forms/elastic_solutions.h"
#include "simulator/common/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

constexpr double kMegapascal = 1e6;

TEST(PlaneTraction, MatchesThePatchTestTable) {
  Eigen::Matrix3d stress;
  stress << -20, 3, 2, 3, -25, 1, 2, 1, -30;
  const double table[][3] = {{90, -20, 3.605551}, {65, -23.318151, 5.607531}, {45, -27, 5.196152}};
  const double index[] = {0.312250, 0.416522, 0.333333};
  for (int i = 0; i < 3; ++i) {
    const double dip = table[i][0] * kDegree;
    const PlaneTraction traction = plane_traction(stress, {std::sin(dip), 0, -std::cos(dip)});
    EXPECT_NEAR(traction.normal, table[i][1], 1e-6);
    EXPECT_NEAR(traction.shear_norm, table[i][2], 1e-6);
    EXPECT_NEAR(traction.shear_norm / (-traction.normal * std::tan(30 * kDegree)), index[i], 1e-6);
  }
}

TEST(Compaction, MatchesTheTable) {
  const double c_m = uniaxial_compressibility(11e9, 0.15);
  EXPECT_NEAR(1.0 * 20e6 * c_m * 200, 0.34438503, 1e-8);
  EXPECT_NEAR(0.6 * 20e6 * c_m * 200, 0.20663102, 1e-8);
  EXPECT_NEAR(horizontal_stress_ratio(0.15, 1), 0.82352941, 1e-8);
  EXPECT_NEAR(horizontal_stress_ratio(0.15, 0.6), 0.49411765, 1e-8);
}

TEST(GeertsmaDisc, MatchesTheTableAndItsOwnClosedForm) {
  const GeertsmaDisc disc{11e9, 0.15, 1, -20e6, 200, 2000, 2000};
  EXPECT_NEAR(geertsma_surface_displacement(disc, 0), -0.17147567, 1e-8);
  EXPECT_NEAR(geertsma_surface_displacement(disc, 1000), -0.15254201, 1e-8);
  EXPECT_NEAR(geertsma_surface_displacement(disc, 2000), -0.10460970, 1e-8);
  EXPECT_NEAR(geertsma_surface_displacement(disc, 4000), -0.030357411, 1e-8);
  const GeertsmaDisc flat{11e9, 0.15, 1, -20e6, 200, 6000, 1500};
  EXPECT_NEAR(geertsma_surface_displacement(flat, 0), geertsma_centre_displacement(flat), 1e-9);
}

/// The displaced fault of the tables: h 225, t 75, dip 70°, Δp −25 MPa in both blocks.
DisplacedReservoir table_reservoir() {
  return {6500 * kMegapascal, 0.15, 0.9, 225, 75, 70 * kDegree, -25 * kMegapascal,
          -25 * kMegapascal};
}

TEST(DisplacedFaultStress, MatchesTheTable) {
  const double table[][3] = {{0, 15.047944, 9.565251},
                             {50, 14.602472, 10.789175},
                             {80, 5.305571, 10.877629},
                             {100, 7.185913, 5.711433}};
  for (const auto& row : table) {
    for (const double sign : {1.0, -1.0}) {
      const FaultStressChange change = displaced_fault_stress(table_reservoir(), sign * row[0]);
      EXPECT_NEAR(change.normal / kMegapascal, row[1], 2e-6) << row[0];
      EXPECT_NEAR(change.shear / kMegapascal, row[2], 2e-6) << row[0];
    }
  }
}

TEST(DisplacedFaultStress, OfBothBlocksIsTheSumOfEach) {
  DisplacedReservoir left = table_reservoir(), right = table_reservoir();
  left.right_pressure_change = 0;
  right.left_pressure_change = 0;
  for (const double y : {-170.0, -100.0, 13.0, 101.0, 160.0}) {
    const FaultStressChange both = displaced_fault_stress(table_reservoir(), y);
    EXPECT_NEAR(both.normal,
                displaced_fault_stress(left, y).normal + displaced_fault_stress(right, y).normal,
                1);
    EXPECT_NEAR(both.shear,
                displaced_fault_stress(left, y).shear + displaced_fault_stress(right, y).shear, 1);
  }
}

TEST(FrictionlessSlip, HasThePrintedPlateau) {
  DisplacedReservoir reservoir = table_reservoir();
  reservoir.shear_modulus = 14.95e9 / 2 / 1.15;
  EXPECT_NEAR(frictionless_slip(reservoir, 0), 0.181731, 1e-6);
  EXPECT_NEAR(frictionless_slip(reservoir, -112.5), 0.181731 / 2, 1e-6);
  EXPECT_EQ(frictionless_slip(reservoir, 151), 0);
}

SlippingFault table_fault() {
  return {table_reservoir(), -23600.0 * 3500, 23600, 35e6, -10000, 0.5, 0.9, 0.9, -25e6, 0.52};
}

TEST(InitialFaultTraction, MatchesThePrintedValues) {
  const FaultStressChange start = initial_fault_traction(table_fault(), 0);
  EXPECT_NEAR(start.normal / kMegapascal, -60.038782, 1e-6);
  EXPECT_NEAR(start.shear / kMegapascal, 8.211612, 1e-6);
}

TEST(BoundaryElementSlip, MatchesThePrintedSolutions) {
  const SlipProfile coarse = boundary_element_slip(table_fault(), 0.5);
  const SlipProfile fine = boundary_element_slip(table_fault(), 0.25);
  EXPECT_NEAR(coarse.max_slip * 1e3, 9.276, 1e-3);
  EXPECT_NEAR(fine.max_slip * 1e3, 9.336, 1e-3);
  // First order: the limit is one more difference further on.
  EXPECT_NEAR((2 * fine.max_slip - coarse.max_slip) * 1e3, 9.395, 1e-3);
  EXPECT_NEAR(2 * fine.integral - coarse.integral, 0.4182, 2e-4);
  EXPECT_NEAR(fine.max_slip_y, 71.4, 0.3);
}

TEST(FrictionalCrack, MatchesThePrintedValues) {
  const auto slip = [](double s) {
    return frictional_crack_slip(25e9, 0.25, 100e6, 20 * kDegree, 0.57735, 1, s) * 1e3;
  };
  EXPECT_NEAR(slip(0), 3.807850, 1e-5);
  EXPECT_NEAR(slip(0.6), 3.046280, 1e-5);
  EXPECT_NEAR(slip(0.8), 2.284710, 1e-5);
}

TEST(PennyCrack, MatchesThePrintedValues) {
  EXPECT_NEAR(penny_crack_slip(10e9, 0.25, 5e6, 100, 0), 0.0545674, 1e-7);
  EXPECT_NEAR(penny_crack_moment(0.25, 5e6, 100) / 1e13, 1.142857, 1e-6);
}

}  // namespace
}  // namespace faultsim
