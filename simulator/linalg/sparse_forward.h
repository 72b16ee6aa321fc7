#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "simulator/linalg/supernodes.h"

namespace faultsim {

/// A right-hand side with few entries: (unknown, value), each unknown at most once.
using SparseLoad = std::vector<std::pair<int, double>>;

/// f_g − K_gr K_rr⁻¹ f_r of many sparse loads, one column each (n_last x loads): a forward
/// substitution with the bulk's columns of L leaves it in the tail. A load meets only the
/// supernodes on the way from its unknowns to the root of the elimination tree. Blocks of
/// kForwardWidth loads that lie close in the tree go up together, in level-3 BLAS of that fixed
/// width, so that a column's bits do not depend on what else is asked.
///
/// @param place     unknown → place in the factor.
/// @param n_bulk    places from here on are the trailing ones.
/// @param progress  called with the share done after each block; may throw.
Eigen::MatrixXd condense_sparse(const Supernodes& factor, const std::vector<long>& place,
                                long n_bulk, const std::vector<SparseLoad>& loads,
                                const std::function<void(double)>& progress);

inline constexpr int kForwardWidth = 64;

}  // namespace faultsim
