// How often intervals of 95 % hold what they are of: results/coverage/make. As Markdown on standard
// output. Usage: coverage_study [REPEATS]      (2000 by default: some minutes on one core)

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "campaign/statistics/intervals.h"
#include "campaign/statistics/morris.h"
#include "campaign/statistics/pick_freeze.h"
#include "campaign/statistics/rank_sensitivity.h"
#include "campaign/statistics/weighted.h"
#include "tests/unit/statistics/coverage_table.h"
#include "tests/unit/statistics/known_models.h"
#include "tests/unit/statistics/tiers_coverage.h"

namespace faultsweep {
namespace {

using testing::heading;
using testing::ishigami;
using testing::kConfidence;
using testing::kInfinity;
using testing::Model;
using testing::Point;
using testing::sized;
using testing::Tally;

struct Indices {
  double first = 0, total = 0;
};

/// A model with its output's indices of x.
struct Case {
  std::string name;
  Model model;
  bool has_third = false;  ///< whether z matters.
  double rarest = 1;       ///< of a flag: how many have the rarer value.
  Indices known = {};
};

/// By a sum over midpoints.
Indices by_midpoints(const Case& one) {
  const int n = one.has_third ? 160 : 1600, depth = one.has_third ? 160 : 1;
  double mean = 0, squares = 0, of_x = 0, of_others = 0;
  std::vector<double> over_x(static_cast<std::size_t>(n) * static_cast<std::size_t>(depth));
  for (int i = 0; i < n; ++i) {
    double given_x = 0;
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < depth; ++k) {
        const double y = one.model({(i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / depth});
        given_x += y / n / depth, squares += y * y / n / n / depth;
        over_x[static_cast<std::size_t>(j * depth + k)] += y / n;
      }
    }
    mean += given_x / n, of_x += given_x * given_x / n;
  }
  for (const double one_mean : over_x)
    of_others += one_mean * one_mean / static_cast<double>(over_x.size());
  const double variance = squares - mean * mean;
  const auto share = [&](double part) { return part > 1e-9 * variance ? part / variance : 0; };
  return {share(of_x - mean * mean), share(squares - of_others)};
}

Model flag_beyond(double p) {
  return [edge = 2 - std::sqrt(2 * p)](const Point& at) { return at[0] + at[1] > edge ? 1.0 : 0; };
}

std::vector<Case> cases() {
  std::vector<Case> all = {
      {"2 x + y", [](const Point& p) { return 2 * p[0] + p[1]; }},
      {"x + 2 y", [](const Point& p) { return p[0] + 2 * p[1]; }},
      {"7 x + y", [](const Point& p) { return 7 * p[0] + p[1]; }},
      {"x³ + 0.3 y", [](const Point& p) { return std::pow(p[0], 3) + 0.3 * p[1]; }},
      {"y², nothing of x", [](const Point& p) { return p[1] * p[1]; }},
      {"Ishigami's first", ishigami(0, 1, 2), true},
      {"Ishigami's second", ishigami(1, 0, 2), true},
      {"Ishigami's third", ishigami(1, 2, 0), true},
      {"exp(3 x + 3 y)", [](const Point& p) { return std::exp(3 * p[0] + 3 * p[1]); }},
      {"max(0, x + y − 1.3)", [](const Point& p) { return std::max(0.0, p[0] + p[1] - 1.3); }},
      {"exp(5 y), nothing of x", [](const Point& p) { return std::exp(5 * p[1]); }},
      {"flag of 50 %, x + y", flag_beyond(0.5), false, 0.5},
      {"flag of 10 %, x + y", flag_beyond(0.1), false, 0.1},
      {"flag of 3 %, x + y", flag_beyond(0.03), false, 0.03},
      {"flag of 50 %, x + y / 5", [](const Point& p) { return p[0] + 0.2 * p[1] > 0.6 ? 1.0 : 0; },
       false, 0.5},
      {"flag of 10 %, x + y / 20",
       [](const Point& p) { return p[0] + 0.05 * p[1] > 0.925 ? 1.0 : 0; }, false, 0.1},
      {"flag of 10 %, nothing of x", [](const Point& p) { return p[1] > 0.9 ? 1.0 : 0; }, false,
       0.1},
      {"flag of 3 %, nothing of x", [](const Point& p) { return p[1] > 0.97 ? 1.0 : 0; }, false,
       0.03}};
  for (Case& one : all) one.known = by_midpoints(one);
  return all;
}

Point draw(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  return {uniform(random), uniform(random), uniform(random)};
}

/// The flags of `one` that a sample of n is likely to have often enough.
bool is_frequent(const Case& one, long n, long fewest) {
  return one.rarest * static_cast<double>(n) >= 1.4 * static_cast<double>(fewest);
}

void study_ranks(const std::vector<Case>& all, int repeats) {
  heading("First order by ranks (`rank_sensitivity`)", "output | rows");
  for (const Case& one : all) {
    for (const long n : {50L, kFewestForRankIndex, 400L, 1000L}) {
      if (!is_frequent(one, n, kFewestOfEitherValue)) continue;
      std::mt19937_64 random(static_cast<std::uint64_t>(n));
      Tally tally;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        std::vector<double> x, y;
        for (long i = 0; i < n; ++i) {
          const Point at = draw(random);
          x.push_back(at[0]), y.push_back(one.model(at));
        }
        const Estimate index = RankSensitivity({&x, 1}).first_order(y, kConfidence)[0];
        tally.add(index.bounds, one.known.first);
      }
      char text[80];
      std::snprintf(text, sizeof text, "%s (%.2f)", one.name.c_str(), one.known.first);
      const bool is_near_one = one.known.first > 0.95;
      tally.print(text, sized(n, is_near_one ? kFewestForRankIndexNearOne : kFewestForRankIndex));
    }
  }
}

void study_pick_freeze(const std::vector<Case>& all, int repeats) {
  heading("First and total order by pick-freeze (`pick_freeze`)", "output | points");
  for (const Case& one : all) {
    for (const long n : {64L, kFewestForPickFreeze, 512L}) {
      if (!is_frequent(one, 2 * n, kFewestOfEitherValueInBlocks)) continue;
      std::mt19937_64 random(static_cast<std::uint64_t>(n));
      Tally first, total;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        PickFreezeValues values;
        values.ab.resize(1);
        for (long k = 0; k < n; ++k) {
          const Point a = draw(random), b = draw(random);
          values.a.push_back(one.model(a)), values.b.push_back(one.model(b));
          values.ab[0].push_back(one.model({b[0], a[1], a[2]}));
        }
        const SobolIndices found = indices_by_pick_freeze(values, kConfidence)[0];
        first.add(found.first.bounds, one.known.first);
        total.add(found.total.bounds, one.known.total);
      }
      char text[80];
      std::snprintf(text, sizeof text, "%s, first (%.2f)", one.name.c_str(), one.known.first);
      first.print(text, sized(n, kFewestForPickFreeze));
      std::snprintf(text, sizeof text, "%s, total (%.2f)", one.name.c_str(), one.known.total);
      total.print(text, sized(n, kFewestForPickFreeze));
    }
  }
}

/// How far x + 0.7 y is beyond a threshold that falls from step to step, or whether it is.
struct Curve {
  bool is_flag = false;
  static constexpr int kSteps = 6;
  double at(const Point& p, int step) const {
    const double beyond = std::max(0.0, p[0] + 0.7 * p[1] - 1.4 + 0.15 * step);
    return is_flag ? (beyond > 0 ? 1.0 : 0.0) : beyond;
  }
  /// Σ V S / Σ V.
  Indices known() const {
    double first = 0, total = 0, all = 0;
    for (int step = 0; step < kSteps; ++step) {
      const Case one{"", [&](const Point& p) { return at(p, step); }};
      double mean = 0, squares = 0;
      constexpr int kCells = 1600;
      for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
          const double y = at({(i + 0.5) / kCells, (j + 0.5) / kCells, 0}, step);
          mean += y / kCells / kCells, squares += y * y / kCells / kCells;
        }
      }
      const double variance = squares - mean * mean;
      const Indices indices = by_midpoints(one);
      first += variance * indices.first, total += variance * indices.total, all += variance;
    }
    return {first / all, total / all};
  }
};

void study_aggregates(int repeats) {
  heading("Six steps together", "output | rows or points");
  for (const bool is_flag : {false, true}) {
    const Curve curve{is_flag};
    const Indices known = curve.known();
    for (const long n : {kFewestForRankIndex, 400L}) {
      std::mt19937_64 random(static_cast<std::uint64_t>(n));
      Tally ranks, first, total;
      for (int repeat = 0; repeat < repeats; ++repeat) {
        std::vector<std::vector<double>> x(1), y(Curve::kSteps);
        std::vector<PickFreezeValues> values(Curve::kSteps);
        for (PickFreezeValues& one : values) one.ab.resize(1);
        for (long k = 0; k < n; ++k) {
          const Point a = draw(random), b = draw(random), ab = {b[0], a[1], a[2]};
          x[0].push_back(a[0]);
          for (int step = 0; step < Curve::kSteps; ++step) {
            const auto s = static_cast<std::size_t>(step);
            y[s].push_back(curve.at(a, step));
            values[s].a.push_back(y[s].back()), values[s].b.push_back(curve.at(b, step));
            values[s].ab[0].push_back(curve.at(ab, step));
          }
        }
        ranks.add(RankSensitivity(x).aggregated(y, kConfidence)[0].bounds, known.first);
        const SobolIndices found = aggregated_by_pick_freeze(values, kConfidence)[0];
        first.add(found.first.bounds, known.first), total.add(found.total.bounds, known.total);
      }
      const std::string name = is_flag ? "onset" : "distance beyond", rows = std::to_string(n);
      ranks.print(name + ", first by ranks", rows);
      first.print(name + ", first by pick-freeze", rows);
      total.print(name + ", total by pick-freeze", rows);
    }
  }
}

/// θ ~ N(0, 1)², y = 2 θ1 + θ2 seen as 3 with an error: what θ1 then is, known in closed form.
struct Seen {
  double error;
  double mean() const { return 6 / (5 + error * error); }
  double deviation() const { return std::sqrt(1 - 4 / (5 + error * error)); }
};

struct WeightedTallies {
  Tally even, rare, median, tail;
  void add(const Seen& seen, long n, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::vector<double> theta;
    std::vector<WeightRange> weights;
    std::vector<Holds> above, far;
    for (long i = 0; i < n; ++i) {
      theta.push_back(normal(random));
      const double off = (2 * theta.back() + normal(random) - 3) / seen.error;
      const double weight = std::exp(-0.5 * off * off);
      weights.push_back({weight, weight});
      const double rare_from = seen.mean() + 1.644854 * seen.deviation();
      above.push_back(theta.back() > seen.mean() ? Holds::yes : Holds::no);
      far.push_back(theta.back() > rare_from ? Holds::yes : Holds::no);
    }
    std::vector<std::size_t> order(theta.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return theta[a] < theta[b]; });
    const auto quantile = [&](double q) {
      const QuantileBounds b = weighted_quantile(theta, weights, order, q, kConfidence);
      return Interval{b.low.value_or(-kInfinity), b.high.value_or(kInfinity)};
    };
    even.add(weighted_probability(above, weights, kConfidence).bounds, 0.5);
    rare.add(weighted_probability(far, weights, kConfidence).bounds, 0.05);
    median.add(quantile(0.5), seen.mean());
    tail.add(quantile(0.95), seen.mean() + 1.644854 * seen.deviation());
  }
};

void study_weighted(int repeats) {
  heading("Weighted members (`weighted`)", "of | effective members, about");
  struct Size {
    double error;
    long n;
    long effective;
  };
  for (const auto& [error, n, effective] :
       {Size{0.5, 400, 50}, {0.5, 1150, 150}, {0.5, 2300, 300}, {2, 260, 150}}) {
    std::mt19937_64 random(static_cast<std::uint64_t>(n));
    WeightedTallies all;
    for (int repeat = 0; repeat < repeats; ++repeat) all.add({error}, n, random);
    const std::string text = sized(effective, static_cast<long>(kFewestEffectiveMembers));
    all.even.print("probability 0.5", text);
    all.rare.print("probability 0.05", text);
    all.median.print("median", text);
    all.tail.print("95 % quantile", text);
  }
}

/// The effects of the first parameter of a model on the four levels of Morris' design.
class MorrisCase {
 public:
  MorrisCase(std::string name, Model model) : name_(std::move(name)), model_(std::move(model)) {
    double squares = 0;
    for (int point = 0; point < 64; ++point) {
      const std::array<int, 3> from = {point % 4, point / 4 % 4, point / 16};
      const double effect = effect_from(from);
      mean_ += effect / 64, magnitude_ += std::abs(effect) / 64, squares += effect * effect / 64;
    }
    deviation_ = std::sqrt(squares - mean_ * mean_);
  }
  void study(int trajectories, int repeats) const {
    std::mt19937_64 random(static_cast<std::uint64_t>(trajectories));
    Tally mean, magnitude, deviation;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      std::vector<std::vector<double>> x(1);
      std::vector<double> y;
      for (int t = 0; t < trajectories; ++t) {
        std::array<int, 3> levels{};
        for (int& one : levels) one = static_cast<int>(random() % 4);
        x[0].push_back(levels[0]), y.push_back(model_(at(levels)));
        levels[0] += levels[0] < 2 ? 2 : -2;
        x[0].push_back(levels[0]), y.push_back(model_(at(levels)));
      }
      const auto found = MorrisDesign::make(x, 2.0 / 3).design->effects(y, kConfidence)[0];
      mean.add(found.mean.bounds, mean_);
      magnitude.add(found.mean_magnitude.bounds, magnitude_);
      deviation.add(found.deviation.bounds, deviation_);
    }
    const std::string text = sized(trajectories, kFewestTrajectories);
    mean.print(name_ + ", μ", text);
    magnitude.print(name_ + ", μ*", text);
    deviation.print(name_ + ", σ", sized(trajectories, kFewestForDeviation));
  }

 private:
  static Point at(const std::array<int, 3>& levels) {
    return {levels[0] / 3.0, levels[1] / 3.0, levels[2] / 3.0};
  }
  double effect_from(std::array<int, 3> levels) const {
    const double before = model_(at(levels)), step = levels[0] < 2 ? 2 : -2;
    levels[0] += static_cast<int>(step);
    return (model_(at(levels)) - before) / (step / 3);
  }
  std::string name_;
  Model model_;
  double mean_ = 0, magnitude_ = 0, deviation_ = 0;
};

double g_function(const Point& x, const std::array<double, 3>& a) {
  double product = 1;
  for (std::size_t i = 0; i < 3; ++i) product *= (std::abs(4 * x[i] - 2) + a[i]) / (1 + a[i]);
  return product;
}

void study_morris(int repeats) {
  heading("Elementary effects (`morris`), four levels", "effects | trajectories");
  const MorrisCase all[] = {
      {"G function, a = 0, 1, 9",
       [](const Point& p) {
         return g_function(p, {0, 1, 9});
       }},
      {"G function, a = 9, 1, 0",
       [](const Point& p) {
         return g_function(p, {9, 1, 0});
       }},
      {"exp(2 x + 1.5 y)", [](const Point& p) { return std::exp(2 * p[0] + 1.5 * p[1]); }},
      {"exp(x / 5 + 2 y + 1.5 z)",
       [](const Point& p) { return std::exp(0.2 * p[0] + 2 * p[1] + 1.5 * p[2]); }},
      {"max(0, x + y − 0.9)", [](const Point& p) { return std::max(0.0, p[0] + p[1] - 0.9); }}};
  for (const MorrisCase& one : all)
    for (const long r : {10L, kFewestTrajectories, kFewestForDeviation})
      one.study(static_cast<int>(r), repeats);
}

/// What is covered whatever an adversary does who hides u of n samples, those with a property or
/// those without: the least of both, a sum over the binomial distribution and so exact.
void exact_row(long n, long u, double p) {
  double hides_yes = 0, hides_no = 0, width = 0;
  for (long k = 0; k <= n; ++k) {
    const auto all = static_cast<double>(n), some = static_cast<double>(k);
    const double chance =
        p == 0 || p == 1
            ? (k == (p == 0 ? 0 : n) ? 1 : 0)
            : std::exp(std::lgamma(all + 1) - std::lgamma(some + 1) - std::lgamma(all - some + 1) +
                       some * std::log(p) + (all - some) * std::log1p(-p));
    const auto holds = [p](const Interval& bounds) { return bounds.low <= p && p <= bounds.high; };
    const Interval yes = proportion_bounds(std::max(0L, k - u), u, n, kConfidence);
    const Interval no = proportion_bounds(std::min(k, n - u), u, n, kConfidence);
    if (holds(yes)) hides_yes += chance;
    if (holds(no)) hides_no += chance;
    width += chance * 0.5 * (yes.high - yes.low + no.high - no.low);
  }
  std::printf("| %g | %ld, %ld | %.1f | %.3g |\n", p, n, u,
              std::floor(1000 * std::min({1.0, hides_yes, hides_no}) + 1e-6) / 10, width);
}

void study_exact() {
  heading("Probability with undecided samples (`proportion_bounds`), the least that is covered",
          "probability | samples, undecided");
  for (const long n : {50L, 500L})
    for (const long u : {0L, n / 10, 3 * n / 10})
      for (const double p : {0.0, 0.02, 0.3, 0.5, 1.0}) exact_row(n, u, p);
}

/// Here the adversary hides the largest values, or the smallest.
void study_exact_quantiles(int repeats) {
  heading("Quantiles with undecided samples (`quantile_bounds`)", "quantile | samples, undecided");
  for (const long n : {50L, 500L}) {
    for (const long u : {0L, n / 10, 3 * n / 10}) {
      for (const double q : {0.1, 0.5}) {
        std::mt19937_64 random(static_cast<std::uint64_t>(n));
        std::exponential_distribution<double> value;
        Tally largest, smallest;
        for (int repeat = 0; repeat < repeats; ++repeat) {
          std::vector<double> values(static_cast<std::size_t>(n));
          for (double& one : values) one = value(random);
          std::sort(values.begin(), values.end());
          const auto bounds = [&](std::span<const double> known) {
            const QuantileBounds b = quantile_bounds(known, u, q, kConfidence);
            return Interval{b.low.value_or(-kInfinity), b.high.value_or(kInfinity)};
          };
          const auto n_known = static_cast<std::size_t>(n - u);
          largest.add(bounds(std::span(values).first(n_known)), -std::log1p(-q));
          smallest.add(bounds(std::span(values).last(n_known)), -std::log1p(-q));
        }
        char name[60], text[60];
        std::snprintf(text, sizeof text, "%ld, %ld", n, u);
        std::snprintf(name, sizeof name, "%g, the largest undecided", q);
        largest.print(name, text);
        std::snprintf(name, sizeof name, "%g, the smallest undecided", q);
        smallest.print(name, text);
      }
    }
  }
}

/// Seconds for the first-order indices of a large sample.
void study_time() {
  constexpr std::size_t kRows = 100'000, kParameters = 8, kOutputs = 72;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::vector<double>> x(kParameters), y(kOutputs);
  for (std::vector<double>& column : x)
    for (std::size_t i = 0; i < kRows; ++i) column.push_back(uniform(random));
  for (std::size_t m = 0; m < kOutputs; ++m) {
    for (std::size_t i = 0; i < kRows; ++i) {
      const double value = x[m % kParameters][i] + x[(m / 9) % kParameters][i] * uniform(random);
      // A third are flags, a third lack a value in some rows.
      const bool is_missing = m % 3 == 1 && i % 50 == 7;
      y[m].push_back(is_missing ? std::nan("") : m % 3 == 0 ? (value > 1.2 ? 1.0 : 0.0) : value);
    }
  }
  std::printf(
      "\n### Time\n\nFirst-order indices by ranks of %zu rows, %zu parameters, %zu outputs, "
      "without "
      "reading them:\n\n| threads | s | processor s |\n|---|---|---|\n",
      kRows, kParameters, kOutputs);
  for (const int threads : {1, 2}) {
    const auto from = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    const auto found = RankSensitivity(x, threads).first_order(y, kConfidence, threads);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - from;
    std::printf("| %d | %.2f | %.2f |\n", threads, found.size() == kOutputs ? taken.count() : 0.0,
                static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC);
  }
}

}  // namespace
}  // namespace faultsweep

int main(int argc, char** argv) {
  using namespace faultsweep;
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 2000;
  if (repeats < 1) {
    std::fputs("usage: coverage_study [REPEATS]\n", stderr);
    return 2;
  }
  std::printf("%d samples per row, each with its 95 %% interval; in brackets the index.\n",
              repeats);
  const std::vector<Case> all = cases();
  study_ranks(all, repeats);
  study_pick_freeze(all, repeats);
  study_aggregates(repeats);
  testing::study_tiers(repeats);
  study_weighted(repeats);
  study_morris(repeats);
  study_exact();
  study_exact_quantiles(repeats);
  study_time();
  return 0;
}
