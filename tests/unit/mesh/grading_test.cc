#include "simulator/mesh/grading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

std::vector<double> steps(const std::vector<double>& line) {
  std::vector<double> sizes;
  for (size_t k = 0; k + 1 < line.size(); ++k) sizes.push_back(line[k + 1] - line[k]);
  return sizes;
}

/// Fine from fine_from to fine_to, with lines that must be there.
std::vector<double> graded_line(double a, double b, double fine_from, double fine_to, double fine,
                                double growth, double largest, const std::vector<double>& must) {
  LineBuilder builder(a, b, growth, largest);
  for (const double x : must) builder.add_line(x);
  builder.add_window(fine_from, fine_to, fine);
  return builder.build();
}

double largest_ratio(const std::vector<double>& sizes) {
  double ratio = 1;
  for (size_t k = 0; k + 1 < sizes.size(); ++k)
    ratio = std::max({ratio, sizes[k] / sizes[k + 1], sizes[k + 1] / sizes[k]});
  return ratio;
}

bool contains(const std::vector<double>& line, double x) {
  return std::any_of(line.begin(), line.end(), [&](double y) { return std::abs(x - y) < 1e-12; });
}

TEST(GradedSizes, GrowFromBothEndsToTheMiddle) {
  const std::vector<double> sizes = graded_sizes(1000, 10, 10, 1.3, 1e9);
  EXPECT_DOUBLE_EQ(sizes.front(), 10);
  EXPECT_NEAR(sizes.back(), 10, 1e-9);
  EXPECT_LE(largest_ratio(sizes), 1.3 + 1e-9);
  EXPECT_LT(sizes.size(), 24u);  // 2 · ln(1 + 0.3 · 50)/ln 1.3 = 21.1
  EXPECT_NEAR(sizes[4], sizes[sizes.size() - 5], 1e-9);
}

TEST(GradedSizes, ReachTheCapAndStayThere) {
  const std::vector<double> sizes = graded_sizes(1000, 10, 1e9, 1.3, 30);
  EXPECT_DOUBLE_EQ(sizes.front(), 10);
  EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), 30 + 1e-9);
  EXPECT_NEAR(sizes.back(), 30, 1e-9);
}

TEST(GradedSizes, GrowthOneIsEven) {
  const std::vector<double> sizes = graded_sizes(7, 1, 1, 1, 1e9);
  ASSERT_EQ(sizes.size(), 7u);
  for (const double size : sizes) EXPECT_DOUBLE_EQ(size, 1);
}

TEST(GradedSizes, AddUpToTheLength) {
  for (const double length : {0.3, 1.0, 1.05, 1.7, 2.0, 3.33, 17.0, 1234.5})
    for (const double last : {1.0, 5.0, 1e9}) {
      const std::vector<double> sizes = graded_sizes(length, 1, last, 1.2, 40);
      double sum = 0;
      for (const double size : sizes) sum += size;
      EXPECT_NEAR(sum, length, 1e-12 * length);
      EXPECT_LE(largest_ratio(sizes), 1.2 + 1e-9);
      EXPECT_LE(sizes.front(), 1.1);
    }
}

TEST(GradedLine, IsFineInTheWindowAndGrowsOutside) {
  const std::vector<double> line = graded_line(-1000, 1000, -50, 50, 5, 1.3, 0, {});
  EXPECT_EQ(line.front(), -1000);
  EXPECT_EQ(line.back(), 1000);
  for (int k = -10; k <= 10; ++k) EXPECT_TRUE(contains(line, 5 * k)) << k;
  EXPECT_LE(largest_ratio(steps(line)), 1.3 + 1e-9);
  EXPECT_LT(line.size(), 60u);
}

TEST(GradedLine, AlwaysContainsTheLinesAskedFor) {
  const std::vector<double> must = {-777, -430, 3, 60, 61, 999};
  const std::vector<double> line = graded_line(-1000, 1000, -50, 50, 5, 1.3, 0, must);
  for (const double x : must) EXPECT_TRUE(contains(line, x)) << x;
  EXPECT_TRUE(std::is_sorted(line.begin(), line.end(), std::less_equal<double>()));
}

TEST(GradedLine, KeepsGrowthAcrossLinesAskedForWhereThereIsRoom) {
  const std::vector<double> line =
      graded_line(-4000, 4000, -50, 50, 5, 1.3, 0, {-2100, -600, 700, 3000});
  EXPECT_LE(largest_ratio(steps(line)), 1.3 + 1e-6);
}

TEST(GradedLine, NeverExceedsTheCap) {
  const std::vector<double> sizes = steps(graded_line(0, 5000, 100, 200, 10, 1.5, 123, {1000}));
  EXPECT_LE(*std::max_element(sizes.begin(), sizes.end()), 123 + 1e-9);
}

TEST(GradedLine, StretchesTheFineCellsToFit) {
  const std::vector<double> sizes = steps(graded_line(0, 10, 0, 10, 3, 1.3, 0, {}));
  ASSERT_EQ(sizes.size(), 4u);
  for (const double size : sizes) EXPECT_NEAR(size, 2.5, 1e-12);
}

TEST(LineBuilder, MakesTheCellsBesideALineOfGivenSizeThatSize) {
  LineBuilder builder(-1000, 1000, 1.3, 0);
  builder.add_line(-300, 7);
  builder.add_line(400, 7);
  const std::vector<double> line = builder.build();
  for (const double x : {-300.0, 400.0})
    for (const double side : {-7.0, 7.0}) EXPECT_TRUE(contains(line, x + side)) << x << " " << side;
  EXPECT_LE(largest_ratio(steps(line)), 1.3 + 1e-9);
}

TEST(LineBuilder, MergesLinesCloserThanAMicrometre) {
  LineBuilder builder(0, 1e4, 1.3, 0);
  for (const double x : {100.0, 100.0 + 4e-7, 200.0, 200.001}) builder.add_line(x);
  const std::vector<double> line = builder.build();
  EXPECT_TRUE(contains(line, 100));
  EXPECT_FALSE(contains(line, 100 + 4e-7));
  EXPECT_TRUE(contains(line, 200.001));
}

/// Found before they are made: the lists would take all memory.
TEST(LineBuilder, RefusesMoreCellsThanAnAxisMayHave) {
  EXPECT_THROW(graded_line(0, 1e4, 0, 10, 1, 1.3, 1e-6, {}), InputError);
  EXPECT_THROW(graded_line(0, 1e7, 0, 1e7, 1e-3, 1.3, 0, {}), InputError) << "beyond an int";
  EXPECT_THROW(graded_sizes(1e9, 1, 1, 1, 1), InputError);
  EXPECT_EQ(graded_line(0, 5e4, 0, 5e4, 1, 1.3, 0, {}).size(), 50'001U) << "as many as allowed";
}

}  // namespace
}  // namespace faultsim
