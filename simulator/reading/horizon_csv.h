#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace faultsim {

/// Reads the points of a horizon, m, z up:
///
///   x [m], y [m], depth [m]
///
/// or z [m] in place of depth, in any order of columns (common/table_reader.h). Depths are
/// downwards.
/// @param given  its name for messages.
/// @throws InputError with all that is wrong, line by line.
std::vector<Eigen::Vector3d> parse_horizon_csv(const std::string& text, const std::string& given);

}  // namespace faultsim
