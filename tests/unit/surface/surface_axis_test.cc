#include "simulator/surface/surface_axis.h"

#include <gtest/gtest.h>

#include <cmath>

namespace faultsim {
namespace {

TEST(SurfaceAxis, RunsFromEndToEndInItsOwnScale) {
  SurfaceAxis axis{.name = "salt", .pointers = {}, .unit = "Pa", .from = 1e9, .to = 16e9};
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

TEST(SurfaceAxis, SetsItsValueWithItsUnitEverywhere) {
  JsonDocument document = parse_json(R"({"a": {"b": "1 m"}, "c": 0})", "test");
  const SurfaceAxis axis{.name = "x", .pointers = {"/a/b"}, .unit = "m", .from = 10, .to = 30};
  axis.set(document, 0.5);
  EXPECT_EQ(document.value.at("a").at("b"), "25 m");
  SurfaceAxis number = axis;
  number.unit.clear(), number.pointers = {"/c", "/a/b"};
  number.set(document, -1);
  EXPECT_EQ(document.value.at("c"), 10);
  EXPECT_EQ(document.value.at("a").at("b"), 10);
}

}  // namespace
}  // namespace faultsim
