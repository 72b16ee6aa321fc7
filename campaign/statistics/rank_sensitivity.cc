#include "campaign/statistics/rank_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

}  // namespace

std::vector<std::uint32_t> random_tied_order(std::span<const double> x) {
  std::vector<std::uint32_t> order(x.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (x[a] != x[b]) return x[a] < x[b];
    return scrambled(a) < scrambled(b);
  });
  return order;
}

Estimate first_order_by_ranks(std::span<const double> y, std::span<const std::uint32_t> order,
                              double confidence) {
  FAULTSIM_DEMAND(y.size() == order.size(), y.size(), " values in an order of ", order.size());
  const std::size_t n = y.size();
  if (n < 4) return {};
  const auto count = static_cast<double>(n);
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / count;
  std::vector<double> centred(n);  // in the order of x
  double products = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    centred[i] = y[order[i]] - mean;
    squares += centred[i] * centred[i];
    if (i > 0) products += centred[i - 1] * centred[i];
  }
  if (!(squares > 0)) return {};
  products += 0.5 * (centred[0] * centred[1] + centred[n - 2] * centred[n - 1]);
  const double value = products / squares;
  // What each place adds to the error of the quotient, y_i y_(i+1) − S y_i² but for a sum that
  // telescopes: so it has little trend along x. ȳ enters at second order, being removed.
  const auto influence = [&](std::size_t i) {
    const double here = centred[i], there = centred[i + 1];
    return here * there - 0.5 * value * (here * here + there * there);
  };
  double own = 0, next = 0, other = 0;
  double one_before = 0, two_before = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double here = influence(i);
    own += here * here;
    next += here * one_before;
    other += here * two_before;
    two_before = one_before, one_before = here;
  }
  // Of few rows the covariances may leave nothing: then the terms count as independent.
  const double sum = own + 2 * (next - other), variance = sum > 0 ? sum : own;
  return normal_estimate(value, std::sqrt(variance) / squares, confidence);
}

}  // namespace faultsweep
