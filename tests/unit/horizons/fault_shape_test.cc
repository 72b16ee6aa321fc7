#include "simulator/horizons/fault_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/horizons/bodies.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using test::dipping_fault;
using test::kDegree;
using test::reservoir_body;

/// Of a fault of the body of 4 km with traces at -2000 m, its line the trace.
FaultShape shape_of(const LayeredFault& fault, double trace_depth = -2000) {
  LayeredBody body = reservoir_body();
  body.trace_depth = trace_depth;
  return {body, fault, fault.trace};
}

TEST(FaultShape, APlaneGoesToTheRightDownwards) {
  LayeredFault fault = dipping_fault();
  fault.top = -1000;
  fault.bottom = -3000;
  const FaultShape shape = shape_of(fault);
  EXPECT_NEAR(shape.shift_at(0, -2000), 0, 1e-9);
  EXPECT_NEAR(shape.shift_at(0, -2500), 500 / std::tan(60 * kDegree), 1e-9);
  EXPECT_EQ(shape.shift_at(1, -3000), shape.shift_at(1, -4000)) << "straight down below its end";
  EXPECT_NEAR(shape.shift_at(1, 0), -1000 / std::tan(60 * kDegree), 1e-9);
  EXPECT_THAT(shape.depths(), testing::ElementsAre(-3000, -1000));
  // The trace runs to the north: east is on its right.
  EXPECT_LT((shape.across(0) - Vector2d(1, 0)).norm(), 1e-12);
}

TEST(FaultShape, AProfileIsTakenRelativeToTheDepthOfTraces) {
  LayeredFault fault = dipping_fault();
  fault.profiles = {{{-1000, 5}, {-2000, 105}, {-3000, 405}}};
  const FaultShape shape = shape_of(fault, -2500);
  EXPECT_NEAR(shape.shift_at(0, -2500), 0, 1e-9);
  EXPECT_NEAR(shape.shift_at(0, -1000), -250, 1e-9);
  EXPECT_NEAR(shape.shift_at(0, -3000), 150, 1e-9);
  EXPECT_NEAR(shape.shift_at(0, -4000), 450, 1e-9) << "goes on as its last piece";
  EXPECT_THAT(shape.depths(), testing::ElementsAre(-4000, -3000, -2000, -1000, 0));
  EXPECT_TRUE(shape.is_alike());
  std::ranges::reverse(fault.profiles[0]);
  EXPECT_NEAR(shape_of(fault, -2500).shift_at(0, -4000), 450, 1e-9) << "from below as well";
}

TEST(FaultShape, BetweenPointsOfTheTraceShiftsAreLinear) {
  LayeredFault fault = dipping_fault();
  fault.trace = {{0, -2000}, {0, 1000}, {0, 2000}};
  fault.profiles = {straight_profile(0.2), straight_profile(0.8), straight_profile(-0.1)};
  const std::vector<Vector2d> line = {{0, -2000}, {0, -500}, {0, 1500}, {0, 2000}};
  const FaultShape shape(reservoir_body(), fault, line);
  EXPECT_FALSE(shape.is_alike());
  EXPECT_NEAR(shape.shift_at(0, -3000), 200, 1e-9);
  EXPECT_NEAR(shape.shift_at(1, -3000), 500, 1e-9) << "half way between 0.2 and 0.8";
  EXPECT_NEAR(shape.shift_at(2, -3000), 350, 1e-9) << "half way between 0.8 and -0.1";
  EXPECT_NEAR(shape.shift_at(1, -1500), -250, 1e-9);
  EXPECT_NEAR(shape.shift(shape.along(1) + 150, -3000), 530, 1e-9) << "off its vertices too";
  EXPECT_NEAR(shape.shift(-300, -3000), 200, 1e-9) << "beyond its ends as at them";
  EXPECT_NEAR(shape.shift(4300, -3000), -100, 1e-9);
}

TEST(FaultShape, EqualProfilesAreOne) {
  LayeredFault fault = dipping_fault();
  const FaultShape one = shape_of(fault);
  fault.profiles.push_back(fault.profiles[0]);
  const FaultShape two = shape_of(fault);
  EXPECT_TRUE(two.is_alike());
  for (const double z : {0., -1234.5, -3999.}) EXPECT_EQ(two.shift_at(1, z), one.shift_at(1, z));
}

}  // namespace
}  // namespace faultsim::horizons
