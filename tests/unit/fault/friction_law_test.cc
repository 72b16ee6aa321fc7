#include "simulator/fault/friction_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/common/units.h"

namespace faultsim {
namespace {

CoulombLaw weakening_law(WeakeningLaw weakening) {
  return {weakening, 2e6, 30 * kDegree, 10 * kDegree, 0.8};
}

TEST(LimitShearTraction, IsCoulombBeforeAnySlip) {
  const auto limit = limit_shear_traction(weakening_law(WeakeningLaw::angle), -20e6, 0);
  EXPECT_NEAR(limit.value, 2e6 + 20e6 * std::tan(30 * kDegree), 1e-6);
  EXPECT_NEAR(limit.d_normal_traction, -std::tan(30 * kDegree), 1e-15);
}

TEST(LimitShearTraction, TakesTheDynamicAngleOnceFullyWeakened) {
  for (const auto weakening : {WeakeningLaw::angle, WeakeningLaw::coefficient}) {
    for (const double slip : {0.8, 5.0}) {
      const auto limit = limit_shear_traction(weakening_law(weakening), -20e6, slip);
      EXPECT_NEAR(limit.value, 2e6 + 20e6 * std::tan(10 * kDegree), 1e-6);
      EXPECT_EQ(limit.d_slip, 0);
    }
  }
}

TEST(LimitShearTraction, WeakensTheAngleOrItsTangentLinearly) {
  const double slip = 0.3;
  const double x = slip / 0.8;
  EXPECT_NEAR(limit_shear_traction(weakening_law(WeakeningLaw::angle), -20e6, slip).value,
              2e6 + 20e6 * std::tan((30 - 20 * x) * kDegree), 1e-6);
  EXPECT_NEAR(limit_shear_traction(weakening_law(WeakeningLaw::coefficient), -20e6, slip).value,
              2e6 + 20e6 * ((1 - x) * std::tan(30 * kDegree) + x * std::tan(10 * kDegree)), 1e-6);
}

TEST(LimitShearTraction, HasTheDerivativesThatDifferencesGive) {
  for (const auto weakening : {WeakeningLaw::angle, WeakeningLaw::coefficient}) {
    const CoulombLaw law = weakening_law(weakening);
    for (const double slip : {0.1, 0.4, 0.79, 1.3}) {
      const auto at = limit_shear_traction(law, -20e6, slip);
      const double h = 1e-6;
      const double d_slip = (limit_shear_traction(law, -20e6, slip + h).value -
                             limit_shear_traction(law, -20e6, slip - h).value) /
                            (2 * h);
      const double step = 100;
      const double d_normal = (limit_shear_traction(law, -20e6 + step, slip).value -
                               limit_shear_traction(law, -20e6 - step, slip).value) /
                              (2 * step);
      EXPECT_NEAR(at.d_slip, d_slip, 1e-7 * 1e7);
      EXPECT_NEAR(at.d_normal_traction, d_normal, 1e-9);
      if (slip < 0.8) {
        EXPECT_LT(at.d_slip, -5e6);  // else the comparison means nothing
      }
      EXPECT_LT(at.d_normal_traction, -0.1);
    }
  }
}

TEST(LimitShearTraction, IgnoresTheWeakeningDistanceWithoutWeakening) {
  CoulombLaw law{WeakeningLaw::angle, 0, 30 * kDegree, 30 * kDegree,
                 std::numeric_limits<double>::quiet_NaN()};
  EXPECT_NEAR(limit_shear_traction(law, -1e6, 0.4).value, 1e6 * std::tan(30 * kDegree), 1e-8);
  law.slip_weakening_distance = 0;
  EXPECT_EQ(limit_shear_traction(law, -1e6, 0.4).d_slip, 0);
}

TEST(LimitShearTraction, RefusesTensionNegativeSlipAndNaN) {
  const CoulombLaw law = weakening_law(WeakeningLaw::angle);
  EXPECT_THROW(limit_shear_traction(law, 1, 0), InternalError);
  EXPECT_THROW(limit_shear_traction(law, -1, -1e-9), InternalError);
  EXPECT_THROW(limit_shear_traction(law, std::nan(""), 0), InternalError);
}

TEST(CriticalIndex, HasAFloorOfOneKilopascal) {
  EXPECT_DOUBLE_EQ(critical_index(6e6, 12e6), 0.5);
  EXPECT_DOUBLE_EQ(critical_index(500, 0), 0.5);
}

TEST(NucleationLength, IsThatOfUenishiAndRice) {
  // G 6500 MPa, ν 0.15, N 36 MPa, Δμ 0.32, d_c 0.02 m.
  EXPECT_NEAR(nucleation_length(6500e6 / (1 - 0.15), 36e6 * 0.32 / 0.02), 15.370773, 1e-6);
  EXPECT_EQ(nucleation_length(1e9, 0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace faultsim
