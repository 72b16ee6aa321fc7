#include "campaign/statistics/pick_freeze.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

struct PairSums {
  double product = 0, squares = 0, both = 0;
  void add(double u, double v, double times) {
    product += times * u * v;
    squares += times * (u * u + v * v);
    both += times * (u + v);
  }
  double correlation(double n) const {
    const double m = 0.5 * both / n;
    const double variance = 0.5 * squares / n - m * m;
    return variance > 0 ? (product / n - m * m) / variance : 0;
  }
};

using Values = std::vector<double>;

/// r(u, v) with its standard error: by how much it changes as each point is left out in turn.
Estimate correlation(const Values& u, const Values& v, double confidence) {
  const auto n = static_cast<double>(u.size());
  PairSums all;
  for (std::size_t k = 0; k < u.size(); ++k) all.add(u[k], v[k], 1);
  double sum = 0, squares = 0;
  const double value = all.correlation(n);
  for (std::size_t k = 0; k < u.size(); ++k) {
    PairSums others = all;
    others.add(u[k], v[k], -1);
    const double change = others.correlation(n - 1) - value;
    sum += change;
    squares += change * change;
  }
  return normal_estimate(value, std::sqrt((n - 1) / n * (squares - sum * sum / n)), confidence);
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
  return std::any_of(values.a.begin(), values.a.end(), differs) ||
         std::any_of(values.b.begin(), values.b.end(), differs);
}

}  // namespace

std::vector<SobolIndices> indices_by_pick_freeze(const PickFreezeValues& values,
                                                 double confidence) {
  const std::size_t n = values.a.size();
  FAULTSIM_DEMAND(values.b.size() == n, values.b.size(), " and ", n, " points");
  std::vector<SobolIndices> indices(values.ab.size());
  if (n < 4 || !varies(values)) return indices;
  const PickFreezeValues y = centred(values);
  for (std::size_t p = 0; p < indices.size(); ++p) {
    FAULTSIM_DEMAND(y.ab[p].size() == n, y.ab[p].size(), " and ", n, " points");
    indices[p] = {correlation(y.b, y.ab[p], confidence),
                  one_minus(correlation(y.a, y.ab[p], confidence))};
  }
  return indices;
}

}  // namespace faultsweep
