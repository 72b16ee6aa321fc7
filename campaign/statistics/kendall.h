#pragma once

#include <optional>
#include <vector>

namespace faultsweep {

/// Kendall's τ-b of n pairs of ranks (equal ranks are ties), in n log n steps:
///   τ_b = (C − D)/√((P − T_a)(P − T_b)),   P = n(n−1)/2,
/// C and D concordant and discordant pairs, T pairs tied in a or b. None where all of a or of b are
/// tied. Kendall, Biometrika 33 (1945) 239; D by counting exchanges in a merge sort: Knight, J. Am.
/// Stat. Assoc. 61 (1966) 436. @pre a and b are equally long.
std::optional<double> kendall_tau_b(const std::vector<long>& a, const std::vector<long>& b);

}  // namespace faultsweep
