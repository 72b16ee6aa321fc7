#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "campaign/statistics/intervals.h"

namespace faultsweep {

/// The order that sorts x; equal values in an order that is random, but the same for the same
/// numbers: neighbours must not share what else varies, as they would in the order of a grid.
std::vector<std::uint32_t> random_tied_order(std::span<const double> x);

/// First-order Sobol' index S = Var E[y | x] / Var y from any independent sample of (x, y), by
/// ranks (Gamboa, Gremaud, Klein & Lagnoux 2022): with y_(i) the deviations from the mean in the
/// order of x,
///
///   S ≈ [Σ_{i<n} y_(i) y_(i+1) + ½ (y_(1) y_(2) + y_(n−1) y_(n))] / Σ y_i²,
///
/// as neighbours share what x explains. The half products stand for the two ends, where their paper
/// pairs the last with the first: that would leave an error of order 1/n. One sort of x serves
/// every output. Variance: of each term, and twice the covariance of neighbours, which share a y,
/// beyond that of any two.
/// @param order  of x, as random_tied_order.  @return zeros where y does not vary or n < 4.
Estimate first_order_by_ranks(std::span<const double> y, std::span<const std::uint32_t> order,
                              double confidence);

}  // namespace faultsweep
