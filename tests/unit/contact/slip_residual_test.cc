#include "simulator/contact/slip_residual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace faultsim {
namespace {

SlipPoint random_point(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  SlipPoint point;
  point.normal_traction = -10 + 3 * uniform(engine);
  point.shear_traction = {6 * uniform(engine), 6 * uniform(engine)};
  point.slip_increment = {0.2 * uniform(engine), 0.2 * uniform(engine)};
  point.before.slip = {0.1 * uniform(engine), 0.1 * uniform(engine)};
  point.before.path = 0.15;
  point.stiffness = 12;
  return point;
}

TEST(SlipResidual, HasTheDerivativesThatDifferencesGive) {
  for (const bool cumulated : {false, true}) {
    const NodeLaw law({.cohesion = 1,
                       .static_friction_angle = 0.5,
                       .dynamic_friction_angle = 0.2,
                       .slip_weakening_distance = 2.0,
                       .slip_measure = cumulated ? SlipMeasure::cumulated : SlipMeasure::current,
                       .damping = 14});
    std::mt19937 engine(7);
    double largest = 0;
    for (int sample = 0; sample < 100; ++sample) {
      SlipPoint point = random_point(engine);
      if (sample % 2 == 1) point.per_second = 0.5;
      const SlipResidual at = slip_residual(law, point);
      const auto difference = [&](auto change) {
        const double h = 1e-6;
        SlipPoint more = point;
        SlipPoint less = point;
        change(more, h);
        change(less, -h);
        return Eigen::Vector2d((slip_residual(law, more).value - slip_residual(law, less).value) /
                               (2 * h));
      };
      const Eigen::Vector2d d_normal =
          difference([](SlipPoint& p, double h) { p.normal_traction += h; });
      EXPECT_LT((at.d_normal - d_normal).norm(), 1e-7);
      for (int c = 0; c < 2; ++c) {
        const Eigen::Vector2d d_shear =
            difference([c](SlipPoint& p, double h) { p.shear_traction[c] += h; });
        const Eigen::Vector2d d_slip =
            difference([c](SlipPoint& p, double h) { p.slip_increment[c] += h; });
        EXPECT_LT((at.d_shear.col(c) - d_shear).norm(), 1e-7);
        EXPECT_LT((at.d_slip.col(c) - d_slip).norm(), 2e-7);
        largest = std::max(largest, d_slip.norm());
      }
    }
    EXPECT_GT(largest, 1);  // else the comparison means nothing
  }
}

TEST(SlipResidual, VanishesForSlipAlongTheLimitTraction) {
  const NodeLaw law({WeakeningLaw::angle, 1, 0.5, 0.5});
  SlipPoint point;
  point.normal_traction = -4;
  const double limit = 1 + 4 * std::tan(0.5);
  point.shear_traction = limit * Eigen::Vector2d(0.6, 0.8);
  point.slip_increment = 0.3 * Eigen::Vector2d(0.6, 0.8);
  point.stiffness = 5;
  EXPECT_LT(slip_residual(law, point).value.norm(), 1e-14);
  EXPECT_NEAR(slip_residual(law, point).excess, 1.5, 1e-14);
  point.slip_increment *= -1;  // against its traction
  EXPECT_LT(slip_residual(law, point).excess, 0);
}

TEST(SlipResidual, StartsAlongTheTraction) {
  const NodeLaw law({WeakeningLaw::angle, 0, 0.5, 0.5});
  SlipPoint point;
  point.normal_traction = -4;
  point.shear_traction = {3, 4};
  const SlipResidual at = slip_residual(law, point);
  EXPECT_NEAR(at.value[0] / at.value[1], 0.75, 1e-14);
}

}  // namespace
}  // namespace faultsim
