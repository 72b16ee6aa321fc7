#include "campaign/statistics/rank_sensitivity.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <thread>

#include "campaign/common/names.h"
#include "campaign/statistics/correlation_bounds.h"
#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

/// A number that looks random, of each number (the finaliser of SplitMix64, Steele et al. 2014).
std::uint64_t scrambled(std::uint64_t k) {
  k += 0x9e3779b97f4a7c15u;
  k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9u;
  k = (k ^ (k >> 27)) * 0x94d049bb133111ebu;
  return k ^ (k >> 31);
}

constexpr double kFreedomPerRow = 0.7;
constexpr double kFreedomPerRowOfFlags = 0.5;

/// What the values of an output, or of several, say at each place in the order of a parameter.
/// Beyond the two ends lie the values next to them, mirrored.
class Places {
 public:
  void start(std::size_t n) {
    squares_.assign(n, 0.0), next_.assign(n, 0.0), across_.assign(n, 0.0);
    n_outputs_ = 0;
  }
  /// @param y  deviations from their mean, in the order; at least 4.
  void add(std::span<const double> y) {
    const std::size_t n = y.size();
    ++n_outputs_;
    const auto add_at = [&](std::size_t i, double before, double after) {
      squares_[i] += y[i] * y[i];
      next_[i] += y[i] * after;
      across_[i] += before * after;
    };
    add_at(0, y[1], y[1]);
    for (std::size_t i = 1; i + 1 < n; ++i) add_at(i, y[i - 1], y[i + 1]);
    add_at(n - 1, y[n - 2], y[n - 2]);
  }
  /// @param rare  where all outputs have two values only.
  Estimate index(const std::optional<RareValue>& rare, double confidence) const;

 private:
  double variance_of_terms(double value) const;
  double variance_of_rows(double value) const;

  std::vector<double> squares_, next_, across_;  ///< y_i², y_i y_(i+1), y_(i−1) y_(i+1).
  int n_outputs_ = 0;
};

/// Sums of products of numbers with themselves and those one and two before.
struct LaggedSums {
  double sum = 0, own = 0, next = 0, other = 0;
  double one_before = 0, two_before = 0;
  void add(double here) {
    sum += here;
    own += here * here;
    next += here * one_before;
    other += here * two_before;
    two_before = one_before, one_before = here;
  }
};

/// Of Σ (y_i y_(i+1) − S y_i²) but for a sum that telescopes: so its terms have little trend along
/// x. ȳ enters at second order, being removed.
double Places::variance_of_terms(double value) const {
  LaggedSums lagged;
  for (std::size_t i = 0; i + 1 < next_.size(); ++i)
    lagged.add(next_[i] - 0.5 * value * (squares_[i] + squares_[i + 1]));
  // Of few rows the covariances may leave nothing: then the terms count as independent.
  const double variance = lagged.own + 2 * (lagged.next - lagged.other);
  return variance > 0 ? variance : lagged.own;
}

/// By what leaving out row j changes. With y = m(x) + e it is m² + 2 m e_j − S y_j² and
/// e_j (e_(j−1) + e_(j+1)) − e_(j−1) e_(j+1): three products of errors where the estimate has one
/// per row. Neighbouring rows share one: so two times their covariance, beyond that of rows two
/// apart, is taken off again. May be negative.
double Places::variance_of_rows(double value) const {
  const std::size_t n = next_.size();
  LaggedSums lagged;
  for (std::size_t j = 0; j < n; ++j)
    lagged.add(next_[j == 0 ? 0 : j - 1] + next_[j] - across_[j] - value * squares_[j]);
  return lagged.own - lagged.sum * lagged.sum / static_cast<double>(n) -
         2 * (lagged.next - lagged.other);
}

Estimate Places::index(const std::optional<RareValue>& rare, double confidence) const {
  const std::size_t n = squares_.size();
  double squares = 0, products = 0.5 * (next_[0] + next_[n - 2]);
  EffectiveRows effective;
  for (std::size_t i = 0; i < n; ++i) squares += squares_[i], effective.add(squares_[i]);
  if (!(squares > 0)) return {};
  for (std::size_t i = 0; i + 1 < n; ++i) products += next_[i];
  const double value = products / squares;
  const double centre = value + (1 - value) / static_cast<double>(n);
  const double of_terms = variance_of_terms(value) / (squares * squares);
  // What x does not explain, were it as large everywhere: the least variance that there can be. Of
  // several outputs it is smaller, as they do not go together.
  const double least = n_outputs_ == 1 ? (1 - value) * (1 - value) / static_cast<double>(n) : 0.0;
  if (rare) {
    const double variance = std::max(of_terms, least);
    const double freedom = kFreedomPerRowOfFlags * effective.count();
    return {value, std::sqrt(variance),
            flag_correlation_bounds(centre, variance, *rare, freedom, confidence)};
  }
  // Estimates scatter: the larger of two is too large on average, so bounds do not go all the way,
  // neither to the least nor to the larger.
  const double of_rows = std::max(variance_of_rows(value) / (squares * squares), 0.6 * least);
  const double variance = 0.5 * (of_rows + std::max(of_rows, of_terms));
  return {value, std::sqrt(variance),
          correlation_bounds(centre, variance, kFreedomPerRow * effective.count(), confidence)};
}

/// Outputs that are analysed together, one or those of an aggregate, as far as they vary.
struct Outputs {
  std::vector<std::span<const double>> values;
  std::vector<double> means;
  std::vector<char> is_left_out;  ///< per row.
  std::size_t n = 0;              ///< rows that count.
  std::optional<RareValue> rare = {};
};

Outputs prepare(std::span<const std::span<const double>> all, std::size_t n_rows) {
  Outputs outputs{{}, {}, std::vector<char>(n_rows, 0), 0};
  for (const std::span<const double> one : all) {
    FAULTSIM_DEMAND(one.size() == n_rows, one.size(), " values of ", n_rows, " rows");
    for (std::size_t row = 0; row < n_rows; ++row)
      if (!std::isfinite(one[row])) outputs.is_left_out[row] = 1;
  }
  outputs.n = static_cast<std::size_t>(std::ranges::count(outputs.is_left_out, 0));
  RareTogether rare;
  std::vector<double> counting;
  for (const std::span<const double> one : all) {
    counting.clear();
    for (std::size_t row = 0; row < n_rows; ++row)
      if (outputs.is_left_out[row] == 0) counting.push_back(one[row]);
    if (std::ranges::adjacent_find(counting, std::not_equal_to<>()) == counting.end())
      continue;  // the same everywhere
    outputs.values.push_back(one);
    outputs.means.push_back(std::accumulate(counting.begin(), counting.end(), 0.0) /
                            static_cast<double>(outputs.n));
    rare.add(rarer_of_two(counting));
  }
  outputs.rare = rare.found();
  return outputs;
}

Estimate analyse(const Outputs& outputs, std::span<const std::uint32_t> order, double confidence) {
  if (outputs.n < 4 || outputs.values.empty()) return {};
  // Kept between calls, of which there are many: else memory would be mapped anew in each.
  thread_local Places places;
  thread_local std::vector<double> centred;
  places.start(outputs.n);
  centred.resize(order.size() + 1);
  for (std::size_t k = 0; k < outputs.values.size(); ++k) {
    std::size_t n = 0;  // one that does not count is overwritten by the next
    for (const std::uint32_t row : order) {
      centred[n] = outputs.values[k][row] - outputs.means[k];
      n += outputs.is_left_out[row] == 0 ? 1 : 0;
    }
    places.add(std::span(centred).first(outputs.n));
  }
  return places.index(outputs.rare, confidence);
}

/// Each of 0 .. n − 1 once, by whichever thread is free.
void for_each(std::size_t n, int n_threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t k = next++; k < n; k = next++) work(k);
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < n_threads && static_cast<std::size_t>(t) < n; ++t) others.emplace_back(run);
  run();
}

}  // namespace

std::vector<std::uint32_t> random_tied_order(std::span<const double> x) {
  struct Place {
    double x;
    std::uint64_t tie;
    std::uint32_t row;
  };
  std::vector<Place> places;
  places.reserve(x.size());
  for (std::uint32_t row = 0; row < x.size(); ++row)
    places.push_back({x[row], scrambled(row), row});
  std::ranges::sort(places, [](const Place& a, const Place& b) {
    return a.x != b.x ? a.x < b.x : a.tie < b.tie;
  });
  return mapped(places, &Place::row);
}

RankSensitivity::RankSensitivity(std::span<const std::vector<double>> parameters, int n_threads)
    : n_rows_(parameters.empty() ? 0 : parameters.front().size()), orders_(parameters.size()) {
  for (const std::vector<double>& x : parameters)
    FAULTSIM_DEMAND(x.size() == n_rows_, x.size(), " and ", n_rows_, " rows");
  for_each(orders_.size(), n_threads,
           [&](std::size_t p) { orders_[p] = random_tied_order(parameters[p]); });
}

std::vector<Estimate> RankSensitivity::first_order(std::span<const double> output,
                                                   double confidence) const {
  std::vector<Estimate> found;
  if (orders_.empty()) return found;
  const Outputs outputs = prepare({&output, 1}, n_rows_);
  for (const auto& order : orders_) found.push_back(analyse(outputs, order, confidence));
  return found;
}

std::vector<std::vector<Estimate>> RankSensitivity::first_order(
    std::span<const std::vector<double>> outputs, double confidence, int n_threads) const {
  for (const std::vector<double>& one : outputs)
    FAULTSIM_DEMAND(one.size() == n_rows_, one.size(), " values of ", n_rows_, " rows");
  std::vector<std::vector<Estimate>> found(outputs.size());
  for_each(outputs.size(), n_threads,
           [&](std::size_t m) { found[m] = first_order(outputs[m], confidence); });
  return found;
}

std::vector<Estimate> RankSensitivity::aggregated(std::span<const std::vector<double>> outputs,
                                                  double confidence) const {
  std::vector<Estimate> found;
  if (orders_.empty()) return found;
  const std::vector<std::span<const double>> all(outputs.begin(), outputs.end());
  const Outputs together = prepare(all, n_rows_);
  for (const auto& order : orders_) found.push_back(analyse(together, order, confidence));
  return found;
}

}  // namespace faultsweep
