// The closed forms of Maxwell salt against a table calculated by hand, and against their equation.
#include "tests/verification/closed_forms/creep_solutions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

const MaxwellSolid kSalt{40e9, 0.3, 1e17};
const Eigen::Matrix3d kNone = Eigen::Matrix3d::Zero();

Eigen::Matrix3d vertical(double strain) {
  Eigen::Matrix3d e = kNone;
  e(2, 2) = strain;
  return e;
}

TEST(MaxwellSolid, HasTheConstantsOfSalt) {
  EXPECT_NEAR(kSalt.shear_modulus() / 1e9, 15.384615, 1e-6);
  EXPECT_NEAR(kSalt.bulk_modulus() / 1e9, 33.333333, 1e-6);
  EXPECT_NEAR(kSalt.relaxation_time(), 6.5e6, 1e-6);
}

TEST(MaxwellStress, OfConfinedStrainHeldMatchesTheTable) {
  const double table[][3] = {{0, 53.846154, 23.076923},
                             {1, 40.879578, 29.560211},
                             {5, 33.471548, 33.264226},
                             {50, 33.333333, 33.333333}};
  for (const auto& row : table) {
    const Eigen::Matrix3d s =
        maxwell_stress(kSalt, vertical(1e-3), kNone, row[0] * kSalt.relaxation_time());
    EXPECT_NEAR(s(2, 2) / 1e6, row[1], 5.1e-7);
    EXPECT_NEAR(s(0, 0) / 1e6, row[2], 5.1e-7);
    EXPECT_EQ(s(0, 0), s(1, 1));
  }
}

TEST(ConfinedColumn, MatchesTheTable) {
  const double table[][3] = {{0, -4.2857143, -1.8571429e-4},
                             {1, -6.9231028, -2.3846206e-4},
                             {5, -9.7413472, -2.9482694e-4},
                             {50, -10, -3.0e-4}};
  for (const auto& row : table) {
    const ConfinedColumn column = confined_column(kSalt, -10e6, row[0] * kSalt.relaxation_time());
    EXPECT_NEAR(column.lateral_stress / 1e6, row[1], 5.1e-8);
    EXPECT_NEAR(column.vertical_strain, row[2], 5.1e-12);
  }
}

/// σ_z = K r t + (4/3) η r (1 − e^{−t/τ}) and σ_xz = G γ e^{−t/τ}, and ṡ/2G + s/2η = ė throughout.
TEST(MaxwellStress, FollowsItsEquation) {
  const double rate = 1e-12, time = 2 * kSalt.relaxation_time();
  EXPECT_NEAR(maxwell_stress(kSalt, kNone, vertical(rate), time)(2, 2),
              100e9 / 3 * rate * time + 4.0 / 3 * 1e17 * rate * (1 - std::exp(-2.0)), 1e-6);
  Eigen::Matrix3d shear = kNone;
  shear(0, 2) = shear(2, 0) = 0.5e-3;
  EXPECT_NEAR(maxwell_stress(kSalt, shear, kNone, time)(0, 2),
              kSalt.shear_modulus() * 1e-3 * std::exp(-2.0), 1e-6);

  const double dt = 1e-3 * kSalt.relaxation_time();
  const auto shear_stress = [&](double t) {
    return maxwell_stress(kSalt, shear, 1e-8 * shear, t)(0, 2);
  };
  const double slope = (shear_stress(time + dt) - shear_stress(time - dt)) / (2 * dt);
  EXPECT_NEAR(slope / (2 * kSalt.shear_modulus()) + shear_stress(time) / 2e17, 1e-8 * shear(0, 2),
              1e-17);
}

}  // namespace
}  // namespace faultsim
