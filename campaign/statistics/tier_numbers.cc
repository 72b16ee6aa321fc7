#include "campaign/statistics/tier_numbers.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

constexpr long kMost = 100'000'000;

/// The least whole number from `low` on for which `is_enough`, which holds from it on; nothing
/// above kMost.
template <typename IsEnough>
std::optional<long> least_number(long low, const IsEnough& is_enough) {
  if (is_enough(low)) return low;
  long short_of = low, enough = 2 * low;
  while (!is_enough(enough)) {
    if (enough > kMost) return std::nullopt;
    short_of = enough, enough *= 2;
  }
  while (enough - short_of > 1) {
    const long middle = short_of + (enough - short_of) / 2;
    (is_enough(middle) ? enough : short_of) = middle;
  }
  return enough;
}

}  // namespace

std::optional<TierNumbers> cheapest_numbers(const HalfWidth& half_width, double wanted,
                                            const TierPrices& prices, long fewest) {
  FAULTSIM_DEMAND(wanted > 0 && fewest > 0 && prices.low_case > 0 && prices.high_case > 0, wanted,
                  ", ", fewest);
  const auto width = [&](long n, long all) {
    return half_width(static_cast<double>(n), static_cast<double>(all));
  };
  const auto with = [&](long n) -> std::optional<TierNumbers> {
    const auto all = least_number(n, [&](long some) { return width(n, some) <= wanted; });
    if (!all) return std::nullopt;
    return TierNumbers{n, *all, width(n, *all),
                       prices.of(static_cast<double>(n), static_cast<double>(*all))};
  };
  // The expensive model alone does it from here on: more of it only costs.
  const auto alone = least_number(fewest, [&](long n) { return width(n, n) <= wanted; });
  if (!alone) return std::nullopt;
  std::optional<TierNumbers> best = with(*alone);
  const auto look_at = [&](double number) {
    const std::optional<TierNumbers> one = with(std::max(fewest, std::lround(number)));
    if (one && one->cost < best->cost) best = one;
  };
  constexpr double kStep = 1.1;
  for (double n = static_cast<double>(fewest); n < static_cast<double>(*alone); n *= kStep)
    look_at(n);
  constexpr int kBetween = 20;
  const auto centre = static_cast<double>(best->n);
  for (int k = -kBetween; k <= kBetween; ++k)
    look_at(centre * std::pow(kStep, k / (1.0 * kBetween)));
  return best;
}

}  // namespace faultsweep
