#pragma once

#include <Eigen/Core>
#include <vector>

namespace faultsim {

/// Which reports a history needs: the first, the last, and as few between as a walk finds that
/// takes from each kept report the furthest one with every report between within `bound` of the
/// straight line in time, in every component. Bound 0 drops what lies on the line exactly.
/// @param time   strictly increasing, s.
/// @param value  what must be kept, n x n_reports: locked tractions, Pa, say.
/// @param bound  >= 0, in the unit of value.
std::vector<int> needed_reports(const std::vector<double>& time, const Eigen::MatrixXd& value,
                                double bound);

}  // namespace faultsim
