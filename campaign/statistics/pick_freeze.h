#pragma once

#include <span>
#include <vector>

#include "campaign/statistics/intervals.h"

namespace faultsweep {

/// Values of one output on the rows of a Sobol' design (Saltelli 2010): N points of two independent
/// samples A and B, and those of A with parameter i of B.
struct PickFreezeValues {
  std::vector<double> a, b;             ///< N each.
  std::vector<std::vector<double>> ab;  ///< [parameter][point].
};

/// Of one parameter.
struct SobolIndices {
  Estimate first;  ///< Var E[y | x_i] / Var y: what it explains alone.
  Estimate total;  ///< 1 − Var E[y | x_others] / Var y: what goes with it, interactions included.
};

/// B and AB_i share x_i and nothing else, A and AB_i all but x_i; so with the correlation of pairs
/// (u, v) as Janon et al. (2014) estimate it, which is efficient,
///
///   r(u, v) = (mean(u v) − m²) / (mean((u² + v²) / 2) − m²),   m = mean((u + v) / 2),
///
/// first_i = r(b, ab_i) and total_i = 1 − r(a, ab_i). Standard errors: by how much r changes as
/// each point is left out in turn (jackknife). Bounds: of a correlation (Fisher's z), Student's t
/// with half a degree of freedom per point that carries the variance; of an output with two values
/// those of a share (Wilson).
///
/// From kFewestForPickFreeze points, and kFewestOfEitherValueInBlocks rows of A and B with each
/// value of an output that has two, 95 % intervals hold 93 to 97 % (results/coverage), and a total
/// of 0 always.
/// @return zeros where nothing varies or N < 4.
std::vector<SobolIndices> indices_by_pick_freeze(const PickFreezeValues& values, double confidence);
inline constexpr long kFewestForPickFreeze = 128;
inline constexpr long kFewestOfEitherValueInBlocks = 40;

/// Of outputs of the same unit together, as a metric at all steps, each counting as much as it
/// varies: r with its numerator and denominator summed over the outputs (Gamboa, Janon, Klein &
/// Lagnoux 2014), standard errors and bounds as above.
/// @param outputs  of the same points and parameters.
std::vector<SobolIndices> aggregated_by_pick_freeze(std::span<const PickFreezeValues> outputs,
                                                    double confidence);

}  // namespace faultsweep
