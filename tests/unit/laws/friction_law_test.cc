#include "simulator/laws/friction_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulator/common/units.h"

namespace faultsim {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Eigen::Vector2d kRest(0, 0);

CoulombLaw weakening_law(WeakeningLaw weakening) {
  return {weakening, 2e6, 30 * kDegree, 10 * kDegree, 0.8};
}

/// At rest, with so much slip behind it.
Strength after_slip(const CoulombLaw& law, double normal_traction, double slip) {
  return NodeLaw(law).strength(normal_traction, kRest, 0, {.slip = {0, slip}, .path = slip});
}

TEST(NodeLaw, IsCoulombBeforeAnySlip) {
  const Strength at = after_slip(weakening_law(WeakeningLaw::angle), -20e6, 0);
  EXPECT_NEAR(at.value, 2e6 + 20e6 * std::tan(30 * kDegree), 1e-6);
  EXPECT_NEAR(at.d_normal, -std::tan(30 * kDegree), 1e-15);
}

TEST(NodeLaw, TakesTheDynamicAngleOnceFullyWeakened) {
  for (const auto weakening : {WeakeningLaw::angle, WeakeningLaw::coefficient}) {
    for (const double slip : {0.8, 5.0}) {
      const Strength at = after_slip(weakening_law(weakening), -20e6, slip);
      EXPECT_NEAR(at.value, 2e6 + 20e6 * std::tan(10 * kDegree), 1e-6);
      EXPECT_EQ(at.d_measure, 0);
    }
  }
}

TEST(NodeLaw, WeakensTheAngleOrItsTangentLinearly) {
  const double slip = 0.3;
  const double x = slip / 0.8;
  EXPECT_NEAR(after_slip(weakening_law(WeakeningLaw::angle), -20e6, slip).value,
              2e6 + 20e6 * std::tan((30 - 20 * x) * kDegree), 1e-6);
  EXPECT_NEAR(after_slip(weakening_law(WeakeningLaw::coefficient), -20e6, slip).value,
              2e6 + 20e6 * ((1 - x) * std::tan(30 * kDegree) + x * std::tan(10 * kDegree)), 1e-6);
}

TEST(NodeLaw, HasTheDerivativesThatDifferencesGive) {
  for (const auto weakening : {WeakeningLaw::angle, WeakeningLaw::coefficient}) {
    for (const bool cumulated : {false, true}) {
      for (const double per_second : {0.0, 2.0}) {
        CoulombLaw constants = weakening_law(weakening);
        constants.slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
        constants.damping = 3e6;
        const NodeLaw law(constants);
        const FrictionState before = {.slip = {0.1, -0.2}, .path = 0.3};
        for (const double size : {0.1, 0.4, 2.0}) {
          const Eigen::Vector2d slip = size * Eigen::Vector2d(0.6, 0.8);
          const Strength at = law.strength(-20e6, slip, per_second, before);
          const auto value = [&](double normal, const Eigen::Vector2d& increment) {
            return law.strength(normal, increment, per_second, before).value;
          };
          EXPECT_NEAR(at.d_normal, (value(-20e6 + 100, slip) - value(-20e6 - 100, slip)) / 200,
                      1e-9);
          EXPECT_LT(at.d_normal, -0.1);
          Eigen::Vector2d d_slip;
          for (int c = 0; c < 2; ++c) {
            const Eigen::Vector2d h = 1e-6 * Eigen::Vector2d::Unit(c);
            d_slip[c] = (value(-20e6, slip + h) - value(-20e6, slip - h)) / 2e-6;
          }
          EXPECT_LT((at.d_slip - d_slip).norm(), 2);
          if (size < 1) {
            EXPECT_LT(at.d_measure, -5e6);  // else the comparison means nothing
          }
        }
      }
    }
  }
}

TEST(NodeLaw, MeasuresSlipByWhereItIsOrByItsPath) {
  const FrictionState before = {.slip = {0.3, 0}, .path = 0.5};
  CoulombLaw constants = weakening_law(WeakeningLaw::angle);
  for (const bool cumulated : {false, true}) {
    constants.slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
    const NodeLaw law(constants);
    EXPECT_DOUBLE_EQ(law.slip_measure(before), cumulated ? 0.5 : 0.3);
    const FrictionState after = law.after(before, {-0.3, 0.4}, false);
    EXPECT_DOUBLE_EQ(after.path, 1.0);
    EXPECT_DOUBLE_EQ(law.slip_measure(after), cumulated ? 1.0 : 0.4);
    EXPECT_EQ(law.is_fully_weakened(after), cumulated);
    EXPECT_EQ(law.strength(-20e6, {-0.3, 0.4}, 0, before).value, law.limit(-20e6, after));
  }
}

TEST(NodeLaw, CohesionEndsByOpeningAndBySlipAsItIsTold) {
  for (const bool survives : {false, true}) {
    const NodeLaw law({.cohesion = 2e6,
                       .static_friction_angle = 0.5,
                       .dynamic_friction_angle = 0.5,
                       .cohesion_after_opening = survives,
                       .cohesion_after_slip = survives});
    EXPECT_TRUE(law.after({}, kRest, false).cohesive);
    EXPECT_EQ(law.after({}, kRest, true).cohesive, survives);
    EXPECT_EQ(law.after({}, {0, 1e-9}, false).cohesive, survives);
    EXPECT_EQ(law.loses_cohesion_slipping(true), !survives);
    EXPECT_FALSE(law.loses_cohesion_slipping(false)) << "it is gone already";
    EXPECT_FALSE(law.after({.cohesive = false}, kRest, false).cohesive) << "it never comes back";
    EXPECT_DOUBLE_EQ(law.limit(-20e6, {.cohesive = false}), 20e6 * std::tan(0.5));
    EXPECT_EQ(law.without_cohesion().limit(-20e6, {.cohesive = false}), 20e6 * std::tan(0.5));
    EXPECT_EQ(law.static_limit(-20e6, true), law.limit(-20e6, {}));
  }
}

TEST(NodeLaw, BoundsTheWeakeningOnTheWay) {
  for (const auto weakening : {WeakeningLaw::angle, WeakeningLaw::coefficient}) {
    for (const bool cumulated : {false, true}) {
      CoulombLaw constants = weakening_law(weakening);
      constants.slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current;
      const NodeLaw law(constants);
      for (const Eigen::Vector2d& start : {Eigen::Vector2d(0.1, 0), {-0.3, 0.05}, {0.9, 0}}) {
        const FrictionState before = {.slip = start, .path = start.norm()};
        const Eigen::Vector2d slip(0.5, 0.2);
        const double bound = law.fastest_weakening(-20e6, slip, before);
        double fastest = 0;
        for (int i = 0; i < 100; ++i) {
          const auto value = [&](double share) {
            return law.strength(-20e6, share * slip, 0, before).value;
          };
          fastest =
              std::max(fastest, (value(0.01 * i) - value(0.01 * (i + 1))) / (0.01 * slip.norm()));
        }
        EXPECT_GE(bound, fastest * (1 - 1e-9));
        EXPECT_LE(bound, 2e7) << "and is no empty promise";
      }
      EXPECT_EQ(law.fastest_weakening(-20e6, {-0.1, 0}, {.slip = {0.3, 0}}) == 0, !cumulated)
          << "a node that goes back heals by the current slip";
    }
  }
}

TEST(NodeLaw, IgnoresTheWeakeningDistanceWithoutWeakening) {
  CoulombLaw law{WeakeningLaw::angle, 0, 30 * kDegree, 30 * kDegree, kNaN};
  EXPECT_NEAR(after_slip(law, -1e6, 0.4).value, 1e6 * std::tan(30 * kDegree), 1e-8);
  law.slip_weakening_distance = 0;
  EXPECT_EQ(after_slip(law, -1e6, 0.4).d_measure, 0);
}

TEST(NodeLaw, CountsTensionAsNoTractionAndKeepsNaN) {
  for (const double dynamic_angle : {10.0, 30.0}) {
    CoulombLaw law = weakening_law(WeakeningLaw::angle);
    law.dynamic_friction_angle = dynamic_angle * kDegree;
    EXPECT_EQ(after_slip(law, 1, 0.1).value, 2e6);
    EXPECT_EQ(after_slip(law, 1, 0.1).d_normal, 0);
    EXPECT_TRUE(std::isnan(after_slip(law, kNaN, 0.1).value));
  }
  EXPECT_TRUE(std::isnan(after_slip(weakening_law(WeakeningLaw::angle), -1, kNaN).value));
}

TEST(NucleationLength, IsThatOfUenishiAndRice) {
  // G 6500 MPa, ν 0.15, N 36 MPa, Δμ 0.32, d_c 0.02 m.
  EXPECT_NEAR(nucleation_length(6500e6 / (1 - 0.15), 36e6 * 0.32 / 0.02), 15.370773, 1e-6);
  EXPECT_EQ(nucleation_length(1e9, 0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace faultsim
