// Scales of colours that say what they are of.
#include "simulator/figure/face_colours.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simulator/figure/palette.h"

namespace faultsim::figure {
namespace {

using Lab = std::array<double, 3>;

/// A colour in CIELAB (CIE 15:2004) with white D65: equal distances look equally far apart.
Lab lab_of(const std::string& colour) {
  std::array<double, 3> linear;
  for (std::size_t c = 0; c < 3; ++c) {
    const double share = std::stoi(colour.substr(1 + 2 * c, 2), nullptr, 16) / 255.0;
    linear[c] = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.95047),
               y = f(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/// Equal changes are equally far apart for the eye, to a sixth, and the larger one is darker.
TEST(FaceColours, OfChangesArePerceptuallyUniform) {
  for (const double end : {-1.0, 1.0}) {
    constexpr int kSteps = 16;
    std::vector<double> steps;
    Lab before = lab_of(change_colour(0));
    double sum = 0;
    for (int k = 1; k <= kSteps; ++k) {
      const Lab now = lab_of(change_colour(end * k / kSteps));
      EXPECT_LT(now[0], before[0] - 2);
      steps.push_back(std::hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]));
      sum += steps.back();
      before = now;
    }
    for (const double step : steps) EXPECT_NEAR(step, sum / kSteps, sum / kSteps / 6);
  }
}

TEST(FaceColours, HaveAScaleThatHoldsAllValuesAndZero) {
  FaceColours colours{FaceColours::Kind::change, "p, bar"};
  EXPECT_TRUE(colours.is_of_zeros());
  for (const double value : {-30.0, -50.0, std::nan(""), -10.0}) colours.hold(value);
  EXPECT_EQ(colours.low, -50);
  EXPECT_EQ(colours.high, 0);
  EXPECT_EQ(colour_of(colours, -50), change_colour(-1));
  EXPECT_EQ(colour_of(colours, 0), change_colour(0));
  EXPECT_THAT(scale_texts(colours), testing::ElementsAre("p, bar", "−50", "−25", "0"));
  colours.hold(100);  // both sides have the colours of the larger one
  EXPECT_EQ(colour_of(colours, -50), change_colour(-0.5));
  EXPECT_THAT(scale_texts(colours), testing::ElementsAre("p, bar", "−50", "25", "100"));
}

TEST(FaceColours, OfAValueAreThoseOfItsPartOfTheScale) {
  FaceColours colours{FaceColours::Kind::change, "p, bar", -100, 60};
  const std::vector<std::string> parts = part_colours(colours, 8);  // of 20 bar
  EXPECT_EQ(parts.size(), 8U);
  EXPECT_EQ(parts[5], colour_of(colours, 10));
  for (const auto& [value, part] :
       {std::pair(-100.0, 0U), {-81.0, 0U}, {-79.0, 1U}, {1.0, 5U}, {60.0, 7U}, {99.0, 7U}})
    EXPECT_EQ(part_of(colours, value, 8), part) << value;
  EXPECT_FALSE(part_of(colours, std::nan(""), 8));
  colours.low = colours.high = 0;
  EXPECT_EQ(part_of(colours, 0, 8), 0U);
  EXPECT_THAT(scale_texts(colours), testing::ElementsAre("p, bar: 0 everywhere", "", "", ""));
}

}  // namespace
}  // namespace faultsim::figure
