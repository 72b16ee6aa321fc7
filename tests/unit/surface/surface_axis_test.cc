#include "simulator/surface/surface_axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

TEST(SurfaceAxis, RunsFromEndToEndInItsOwnScale) {
  SurfaceAxis axis{.from = 1e9, .to = 16e9};
  axis.scale = SurfaceAxis::Scale::logarithm;
  EXPECT_NEAR(axis.value(0), 4e9, 1);
  axis.from = -0.3, axis.to = 0.5, axis.scale = SurfaceAxis::Scale::tangent;
  EXPECT_NEAR(std::tan(axis.value(0)), 0.5 * (std::tan(0.5) - std::tan(0.3)), 1e-15);
  for (const auto scale : {SurfaceAxis::Scale::linear, SurfaceAxis::Scale::tangent}) {
    axis.scale = scale;
    EXPECT_NEAR(axis.value(-1), -0.3, 1e-15);
    EXPECT_NEAR(axis.value(1), 0.5, 1e-15);
    for (const double x : {-1.0, -0.2, 0.7}) EXPECT_NEAR(axis.coordinate(axis.value(x)), x, 1e-14);
  }
}

}  // namespace
}  // namespace faultsim
