#pragma once

#include <functional>
#include <optional>

namespace faultsweep {

/// What cases of a cheap and an expensive model cost, and what is paid once whatever their number
/// (operators): in any unit of cost, as seconds.
struct TierPrices {
  double low_case = 0, high_case = 0;  ///< > 0.
  double once = 0;                     ///< ≥ 0.
  double of(double n, double all) const { return once + n * high_case + all * low_case; }
};

/// Members of a sample at the expensive model (n) and at the cheap one (N ≥ n).
struct TierNumbers {
  long n = 0, all = 0;
  double half_width = 0;
  double cost = 0;
};

/// Half the width of an interval from n and N; it falls with either.
using HalfWidth = std::function<double(double n, double all)>;

/// The numbers whose interval is as narrow as `wanted` for the least cost: for each n the least N
/// that does, n at which the cost is least, searched for over powers of 1.1 and then between them.
/// @param fewest  least n; N is at least that. @pre wanted > 0.
/// Nothing where 10⁸ expensive members do not do.
std::optional<TierNumbers> cheapest_numbers(const HalfWidth& half_width, double wanted,
                                            const TierPrices& prices, long fewest);

}  // namespace faultsweep
