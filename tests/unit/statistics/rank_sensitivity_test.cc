#include "campaign/statistics/rank_sensitivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "campaign/statistics/correlation_bounds.h"
#include "tests/unit/statistics/known_models.h"

namespace faultsweep {
namespace {

using testing::ishigami;
using testing::Model;
using testing::Point;

struct Sample {
  std::vector<double> x, y;  ///< x: the first coordinate.
};

Sample sample(const Model& model, std::size_t n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  Sample s;
  for (std::size_t i = 0; i < n; ++i) {
    const Point p = {uniform(random), uniform(random), uniform(random)};
    s.x.push_back(p[0]);
    s.y.push_back(model(p));
  }
  return s;
}

struct RankedModel {
  const char* name;
  Model model;
  double index;  ///< of the first coordinate.
};

const std::vector<RankedModel>& ranked_models() {
  static const std::vector<RankedModel> all = {
      {"linear, most of it", [](const Point& p) { return 2 * p[0] + p[1]; }, 0.8},
      {"linear, a fifth", [](const Point& p) { return p[0] + 2 * p[1]; }, 0.2},
      {"none", [](const Point& p) { return p[1] * p[1]; }, 0},
      {"all", [](const Point& p) { return std::exp(p[0]); }, 1},
      {"a flag", [](const Point& p) { return p[0] + p[1] > 1 ? 1.0 : 0.0; }, 1.0 / 3},
      {"Ishigami's first", ishigami(0, 1, 2), 0.31390519},
      {"Ishigami's second", ishigami(1, 0, 2), 0.44241114},
      {"Ishigami's third", ishigami(1, 2, 0), 0}};
  return all;
}

Estimate index_of(const std::vector<double>& x, const std::vector<double>& y) {
  return RankSensitivity({&x, 1}).first_order(y, 0.95)[0];
}

TEST(RankSensitivity, MeetsKnownIndices) {
  std::mt19937_64 random(1);
  for (const RankedModel& one : ranked_models()) {
    const Sample s = sample(one.model, 100'000, random);
    const Estimate e = index_of(s.x, s.y);
    EXPECT_NEAR(e.value, one.index, 4 * e.standard_error + 1e-4) << one.name;
    EXPECT_LT(e.standard_error, 0.01) << one.name;
  }
}

int held_of(const RankedModel& one, std::size_t n, int repeats) {
  std::mt19937_64 random(7);
  int held = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const Sample s = sample(one.model, n, random);
    const Estimate e = index_of(s.x, s.y);
    held += e.bounds.low <= one.index && one.index <= e.bounds.high;
  }
  return held;
}

/// Of 1,000 intervals of 95 %, 93 to 98 % hold the index. Not where nothing is left to explain:
/// there is not a scatter.
TEST(RankSensitivity, ItsIntervalsCover) {
  for (const RankedModel& one : ranked_models()) {
    if (one.index == 1) continue;
    for (const std::size_t n : {static_cast<std::size_t>(kFewestForRankIndex), std::size_t{600}}) {
      const int held = held_of(one, n, 1000);
      EXPECT_GE(held, 925) << one.name << ", " << n;
      EXPECT_LE(held, 982) << one.name << ", " << n;
    }
  }
}

/// A flag that one row in thirty has, of x and y or of y alone: of 800 rows as many as
/// kFewestOfEitherValue and a few have it. x + y > 2 − √(1/15): P(flag | x) is x less 1 − √(1/15).
TEST(RankSensitivity, ItsIntervalsCoverOfARareFlag) {
  const double width = std::sqrt(2.0 / 30), p = 1.0 / 30;
  const double index = (width * width * width / 3 - p * p) / (p * (1 - p));
  const RankedModel rare[] = {
      {"of both", [=](const Point& at) { return at[0] + at[1] > 2 - width ? 1.0 : 0.0; }, index},
      {"of the other", [=](const Point& at) { return at[1] < p ? 1.0 : 0.0; }, 0}};
  for (const RankedModel& one : rare) {
    const int held = held_of(one, 800, 1000);
    EXPECT_GE(held, 925) << one.name;
    EXPECT_LE(held, 982) << one.name;
  }
}

/// A few rows carry most of the variance.
TEST(RankSensitivity, ItsIntervalsCoverOfASkewedOutput) {
  const auto exponential = [](const Point& p) { return std::exp(3 * p[0] + 3 * p[1]); };
  // Of e^(3x): (mean of squares) / mean² − 1 = v alone, (1 + v)² − 1 together
  const double v = (std::exp(6.0) - 1) / 6 / std::pow((std::exp(3.0) - 1) / 3, 2) - 1;
  const int held = held_of({"skewed", exponential, v / ((1 + v) * (1 + v) - 1)}, 200, 1000);
  EXPECT_GE(held, 930);
  EXPECT_LE(held, 975);
}

/// A grid's rows share their other parameters with their neighbours: ties must not stay in order.
TEST(RankSensitivity, IsNotMisledByTheOrderOfAGrid) {
  std::vector<double> x, y;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 500; ++b) {
      x.push_back(a);
      y.push_back(std::sin(b * 0.01));  // nothing of a
    }
  }
  const Estimate e = index_of(x, y);
  EXPECT_NEAR(e.value, 0, 4 * e.standard_error);
  EXPECT_LT(e.standard_error, 0.03);
}

TEST(RankSensitivity, IsNeverSureOfItselfWhereSomethingVaries) {
  std::mt19937_64 random(9);
  for (int repeat = 0; repeat < 200; ++repeat) {
    Sample s = sample([](const Point& p) { return p[1] > 0.7 ? 1.0 : 0.0; }, 8, random);
    for (double& value : s.x) value = value < 0.5 ? 0 : 1;
    const Estimate e = index_of(s.x, s.y);
    const bool varies = std::count(s.y.begin(), s.y.end(), s.y[0]) < 8;
    EXPECT_EQ(e.standard_error > 0, varies) << repeat;
  }
}

/// Neither the way in which x goes nor the units of y say how much of y it explains.
TEST(RankSensitivity, IsTheSameFromTheOtherEndAndInOtherUnits) {
  std::mt19937_64 random(12);
  for (const std::size_t n : {5U, 20U, 200U}) {
    const Sample s = sample(ishigami(0, 1, 2), n, random);
    Sample turned = s;
    for (double& x : turned.x) x = -x;
    for (double& y : turned.y) y = 7 - 1e5 * y;
    const Estimate one = index_of(s.x, s.y);
    const Estimate other = index_of(turned.x, turned.y);
    EXPECT_NEAR(one.value, other.value, 1e-9) << n;
    EXPECT_NEAR(one.standard_error, other.standard_error, 1e-9) << n;
  }
}

/// Of places 1, 2, 3, 4 with y = 0, 1, 1, 4: deviations −1.5, −0.5, −0.5, 2.5 with squares 9. The
/// products of neighbours are 0.75, 0.25 and −1.25, and each end counts half once more.
TEST(RankSensitivity, IsItsDefinitionOnFourRows) {
  const std::vector<double> x = {1, 2, 3, 4}, y = {0, 1, 1, 4};
  EXPECT_NEAR(index_of(x, y).value, (0.75 + 0.25 - 1.25 + 0.5 * (0.75 - 1.25)) / 9, 1e-12);
}

/// Parameters and outputs of Ishigami's function and of others, some without a value in some rows.
struct ManyOutputs {
  std::vector<std::vector<double>> x{3}, y{5};
  explicit ManyOutputs(std::size_t n) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t i = 0; i < n; ++i) {
      const Point p = {uniform(random), std::floor(4 * uniform(random)), uniform(random)};
      for (std::size_t k = 0; k < 3; ++k) x[k].push_back(p[k]);
      y[0].push_back(ishigami(0, 1, 2)(p));
      y[1].push_back(p[1] + p[2] > 2 ? 1 : 0);
      y[2].push_back(i % 7 == 3 ? std::nan("") : p[0] + p[1]);
      y[3].push_back(3);
      y[4].push_back(p[0] * p[2]);
    }
  }
};

void expect_same(const Estimate& a, const Estimate& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.standard_error, b.standard_error);
  EXPECT_EQ(a.bounds.low, b.bounds.low);
  EXPECT_EQ(a.bounds.high, b.bounds.high);
}

TEST(RankSensitivity, OfManyOutputsIsThatOfEachBitForBit) {
  const ManyOutputs many(500);
  const RankSensitivity sensitivity(many.x, 3);
  const auto one_thread = sensitivity.first_order(many.y, 0.95, 1);
  const auto four = sensitivity.first_order(many.y, 0.95, 4);
  ASSERT_EQ(four.size(), 5u);
  for (std::size_t m = 0; m < 5; ++m) {
    for (std::size_t p = 0; p < 3; ++p) {
      expect_same(one_thread[m][p], four[m][p]);
      if (m != 2) {
        expect_same(four[m][p], index_of(many.x[p], many.y[m]));
      }
    }
  }
  EXPECT_EQ(four[3][0].standard_error, 0) << "it is the same everywhere";
}

/// Rows without a value: as if they were not there, but for the order of equal x.
TEST(RankSensitivity, LeavesOutRowsWithoutAValue) {
  const ManyOutputs many(500);
  std::vector<double> x, y;
  for (std::size_t i = 0; i < 500; ++i)
    if (i % 7 != 3) x.push_back(many.x[0][i]), y.push_back(many.y[2][i]);
  expect_same(RankSensitivity(many.x).first_order(many.y[2], 0.95)[0], index_of(x, y));
}

TEST(RankSensitivity, OfOutputsTogetherCountsEachAsMuchAsItVaries) {
  const ManyOutputs many(400);
  const RankSensitivity sensitivity(many.x);
  const std::vector<std::vector<double>> outputs = {many.y[0], many.y[1], many.y[4], many.y[3]};
  const auto each = sensitivity.first_order(outputs, 0.95, 1);
  const auto together = sensitivity.aggregated(outputs, 0.95);
  std::vector<double> variances;
  for (const auto& one : outputs) {
    const double mean = std::accumulate(one.begin(), one.end(), 0.0) / 400;
    variances.push_back(0);
    for (const double y : one) variances.back() += (y - mean) * (y - mean);
  }
  for (std::size_t p = 0; p < 3; ++p) {
    double sum = 0, all = 0;
    for (std::size_t m = 0; m < 4; ++m) sum += variances[m] * each[m][p].value, all += variances[m];
    EXPECT_NEAR(together[p].value, sum / all, 1e-12);
  }
  const auto alone = sensitivity.aggregated(std::span(outputs).first(1), 0.95);
  expect_same(alone[0], each[0][0]);
  const std::vector<std::vector<double>> twice = {many.y[0], many.y[0]};
  EXPECT_NEAR(sensitivity.aggregated(twice, 0.95)[0].standard_error, each[0][0].standard_error,
              1e-12)
      << "the same twice says no more";
}

/// Slip-like curves: at step t of 6 a flag, or what x + y is beyond a threshold that falls. Indices
/// by a sum over midpoints.
TEST(RankSensitivity, ItsIntervalsCoverOfOutputsTogether) {
  for (const bool is_flag : {true, false}) {
    const auto curve = [&](double x, double y, int t) {
      const double beyond = std::max(0.0, x + 0.7 * y - 1.4 + 0.15 * t);
      return is_flag ? (beyond > 0 ? 1.0 : 0.0) : beyond;
    };
    constexpr int kCells = 400;
    double explained = 0, all = 0;
    for (int t = 0; t < 6; ++t) {
      double mean = 0, squares = 0, of_means = 0;
      for (int i = 0; i < kCells; ++i) {
        double of_x = 0;
        for (int j = 0; j < kCells; ++j) {
          const double value = curve((i + 0.5) / kCells, (j + 0.5) / kCells, t) / kCells;
          of_x += value, squares += value * value;
        }
        mean += of_x / kCells, of_means += of_x * of_x / kCells;
      }
      explained += of_means - mean * mean, all += squares - mean * mean;
    }
    const double index = explained / all;
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> uniform(0, 1);
    int held = 0;
    for (int repeat = 0; repeat < 1000; ++repeat) {
      std::vector<std::vector<double>> x(1), outputs(6);
      for (int i = 0; i < 300; ++i) {
        x[0].push_back(uniform(random));
        const double y = uniform(random);
        for (int t = 0; t < 6; ++t)
          outputs[static_cast<std::size_t>(t)].push_back(curve(x[0].back(), y, t));
      }
      const Interval bounds = RankSensitivity(x).aggregated(outputs, 0.95)[0].bounds;
      held += bounds.low <= index && index <= bounds.high;
    }
    EXPECT_GE(held, 930) << is_flag;
    EXPECT_LE(held, 980) << is_flag;
  }
}

/// Its error and bounds as the header says them, for values in the order of x: with those beyond
/// the ends mirrored.
struct ByDefinition {
  double value = 0, of_terms = 0, of_rows = 0, least = 0, effective = 0;
  explicit ByDefinition(std::vector<double> y) {
    const auto n = static_cast<double>(y.size());
    const double mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
    for (double& one : y) one -= mean;
    const auto at = [&](long i) {
      const auto last = static_cast<long>(y.size()) - 1;
      return y[static_cast<std::size_t>(i < 0 ? -i : i > last ? 2 * last - i : i)];
    };
    double squares = 0, fourths = 0, products = 0;
    const auto rows = static_cast<long>(y.size());
    for (long i = 0; i < rows; ++i) {
      squares += at(i) * at(i), fourths += std::pow(at(i), 4);
      products += 0.5 * at(i) * (at(i - 1) + at(i + 1));
    }
    value = products / squares, effective = squares * squares / fourths;
    least = (1 - value) * (1 - value) / n;
    std::vector<double> terms, left_out;
    for (long i = 0; i < rows; ++i) {
      const double half = 0.5 * value;
      if (i + 1 < rows)
        terms.push_back(at(i) * at(i + 1) - half * (at(i) * at(i) + at(i + 1) * at(i + 1)));
      left_out.push_back(at(i) * (at(i - 1) + at(i + 1)) - at(i - 1) * at(i + 1) -
                         value * at(i) * at(i));
    }
    const double sum = std::accumulate(left_out.begin(), left_out.end(), 0.0);
    of_terms = (lagged(terms, 0) + 2 * lagged(terms, 1) - 2 * lagged(terms, 2)) / squares / squares;
    of_rows =
        (lagged(left_out, 0) - sum * sum / n - 2 * lagged(left_out, 1) + 2 * lagged(left_out, 2)) /
        squares / squares;
  }
  static double lagged(const std::vector<double>& values, std::size_t lag) {
    double sum = 0;
    for (std::size_t i = lag; i < values.size(); ++i) sum += values[i] * values[i - lag];
    return sum;
  }
};

TEST(RankSensitivity, ItsErrorAndBoundsAreTheirDefinitions) {
  std::mt19937_64 random(31);
  for (const RankedModel& one : ranked_models()) {
    const Sample s = sample(one.model, 60, random);
    const auto order = random_tied_order(s.x);
    std::vector<double> sorted;
    for (const std::uint32_t row : order) sorted.push_back(s.y[row]);
    const ByDefinition known(sorted);
    const Estimate e = index_of(s.x, s.y);
    EXPECT_NEAR(e.value, known.value, 1e-12) << one.name;
    const double centre = known.value + (1 - known.value) / 60;
    const auto rare = rarer_of_two(s.y);
    const double of_rows = std::max(known.of_rows, 0.6 * known.least);
    const double variance = rare ? std::max(known.of_terms, known.least)
                                 : 0.5 * (of_rows + std::max(of_rows, known.of_terms));
    EXPECT_NEAR(e.standard_error, std::sqrt(variance), 1e-9) << one.name;
    const Interval bounds =
        rare ? flag_correlation_bounds(centre, variance, *rare, 0.5 * known.effective, 0.95)
             : correlation_bounds(centre, variance, 0.7 * known.effective, 0.95);
    EXPECT_NEAR(e.bounds.low, bounds.low, 1e-9) << one.name;
    EXPECT_NEAR(e.bounds.high, bounds.high, 1e-9) << one.name;
  }
}

TEST(RankSensitivity, IsZeroWhereNothingVaries) {
  const std::vector<double> x = {1, 2, 3, 4, 5}, y(5, 0.1);
  const Estimate e = index_of(x, y);
  EXPECT_EQ(e.value, 0);
  EXPECT_EQ(e.standard_error, 0);
}

}  // namespace
}  // namespace faultsweep
