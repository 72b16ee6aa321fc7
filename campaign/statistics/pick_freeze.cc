#include "campaign/statistics/pick_freeze.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "campaign/statistics/correlation_bounds.h"
#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

using Values = std::vector<double>;

constexpr double kFreedomPerPoint = 0.5;

struct PairSums {
  double product = 0, squares = 0, both = 0;
  void add(double u, double v, double times) {
    product += times * u * v;
    squares += times * (u * u + v * v);
    both += times * (u + v);
  }
};

/// Numerator and denominator of r, summed over outputs.
struct Quotient {
  double shared = 0, variance = 0;
  void add(const PairSums& sums, double n) {
    const double m = 0.5 * sums.both / n;
    shared += sums.product / n - m * m;
    variance += 0.5 * sums.squares / n - m * m;
  }
  double value() const { return variance > 0 ? shared / variance : 0; }
};

/// The same two blocks of each output.
struct Pairs {
  std::vector<const Values*> u, v;
};

/// r(u, v) and the jackknife's variance of it.
struct Correlation {
  double value = 0, variance = 0;
};

Correlation correlation(const Pairs& pairs) {
  const std::size_t n_points = pairs.u[0]->size();
  const auto n = static_cast<double>(n_points);
  std::vector<PairSums> sums(pairs.u.size());
  Quotient all;
  for (std::size_t m = 0; m < sums.size(); ++m) {
    for (std::size_t k = 0; k < n_points; ++k) sums[m].add((*pairs.u[m])[k], (*pairs.v[m])[k], 1);
    all.add(sums[m], n);
  }
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < n_points; ++k) {
    Quotient others;
    for (std::size_t m = 0; m < sums.size(); ++m) {
      PairSums rest = sums[m];
      rest.add((*pairs.u[m])[k], (*pairs.v[m])[k], -1);
      others.add(rest, n - 1);
    }
    const double change = others.value() - all.value();
    sum += change, squares += change * change;
  }
  return {all.value(), std::max(0.0, (n - 1) / n * (squares - sum * sum / n))};
}

/// What bounds need to know beside r: of A and B, a sample of twice as many points.
struct Blocks {
  double freedom = 0;
  std::optional<RareValue> rare;  ///< its count: of one block.
};

/// @param outputs  their deviations; each varies.
Blocks blocks_of(std::span<const PickFreezeValues> outputs) {
  Values squares(2 * outputs[0].a.size(), 0.0);
  RareTogether rare;
  for (const PickFreezeValues& one : outputs) {
    Values both = one.a;
    both.insert(both.end(), one.b.begin(), one.b.end());
    for (std::size_t k = 0; k < both.size(); ++k) squares[k] += both[k] * both[k];
    rare.add(rarer_of_two(both));
  }
  EffectiveRows effective;
  for (const double one : squares) effective.add(one);
  Blocks blocks{kFreedomPerPoint * 0.5 * effective.count(), rare.found()};
  if (blocks.rare) blocks.rare->count *= 0.5;
  return blocks;
}

Estimate estimate_of(const Pairs& pairs, const Blocks& blocks, double confidence) {
  const Correlation r = correlation(pairs);
  const auto n = static_cast<double>(pairs.u[0]->size());
  Estimate found{r.value, std::sqrt(r.variance), {}};
  if (!blocks.rare) {
    found.bounds = correlation_bounds(r.value, r.variance, blocks.freedom, confidence);
    return found;
  }
  // Of few pairs with the rare value the jackknife sees little: not less than if what they do not
  // share were as large everywhere. Of several outputs it may be less, as they do not go together.
  const double least = pairs.u.size() == 1 ? (1 - r.value) * (1 - r.value) / n : 0.0;
  const double variance = std::max(r.variance, least);
  found.bounds =
      flag_correlation_bounds(r.value, variance, *blocks.rare, blocks.freedom, confidence);
  return found;
}

Estimate one_minus(const Estimate& r) {
  return {1 - r.value, r.standard_error, {1 - r.bounds.high, 1 - r.bounds.low}};
}

/// All values less their mean: sums of squares lose no digits then.
PickFreezeValues centred(PickFreezeValues values) {
  const auto n = static_cast<double>(values.a.size());
  const double mean = 0.5 *
                      (std::accumulate(values.a.begin(), values.a.end(), 0.0) +
                       std::accumulate(values.b.begin(), values.b.end(), 0.0)) /
                      n;
  const auto shift = [&](Values& all) {
    for (double& one : all) one -= mean;
  };
  shift(values.a), shift(values.b);
  for (Values& one : values.ab) shift(one);
  return values;
}

bool varies(const PickFreezeValues& values) {
  const auto differs = [&](double one) { return one != values.a.front(); };
  return std::ranges::any_of(values.a, differs) || std::ranges::any_of(values.b, differs);
}

void check_sizes(std::span<const PickFreezeValues> outputs) {
  FAULTSIM_DEMAND(!outputs.empty(), outputs.size());
  const std::size_t n = outputs[0].a.size(), d = outputs[0].ab.size();
  for (const PickFreezeValues& one : outputs) {
    FAULTSIM_DEMAND(one.a.size() == n && one.b.size() == n, one.b.size(), " and ", n, " points");
    FAULTSIM_DEMAND(one.ab.size() == d, one.ab.size(), " and ", d, " parameters");
    for (const Values& mixed : one.ab)
      FAULTSIM_DEMAND(mixed.size() == n, mixed.size(), " and ", n, " points");
  }
}

}  // namespace

std::vector<SobolIndices> aggregated_by_pick_freeze(std::span<const PickFreezeValues> outputs,
                                                    double confidence) {
  check_sizes(outputs);
  std::vector<SobolIndices> indices(outputs[0].ab.size());
  if (outputs[0].a.size() < 4) return indices;
  std::vector<PickFreezeValues> y;
  for (const PickFreezeValues& one : outputs)
    if (varies(one)) y.push_back(centred(one));
  if (y.empty()) return indices;
  const Blocks blocks = blocks_of(y);
  for (std::size_t p = 0; p < indices.size(); ++p) {
    Pairs alone, others;
    for (const PickFreezeValues& one : y) {
      alone.u.push_back(&one.b), alone.v.push_back(&one.ab[p]);
      others.u.push_back(&one.a), others.v.push_back(&one.ab[p]);
    }
    indices[p] = {estimate_of(alone, blocks, confidence),
                  one_minus(estimate_of(others, blocks, confidence))};
  }
  return indices;
}

std::vector<SobolIndices> indices_by_pick_freeze(const PickFreezeValues& values,
                                                 double confidence) {
  return aggregated_by_pick_freeze({&values, 1}, confidence);
}

}  // namespace faultsweep
