#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace faultsim {

/// What a table says of a horizon, m.
struct HorizonTable {
  std::vector<Eigen::Vector3d> points;  ///< z up; of thicknesses, the thickness in its place.
  bool is_thickness = false;
  std::vector<int> line;  ///< of the file, per point.
};

/// Reads the points of a horizon:
///
///   x [m], y [m], depth [m]
///
/// or z [m] in place of depth, or thickness [m], > 0: how much deeper than the horizon above; in
/// any order of columns (common/table_reader.h). Depths are downwards.
/// @param given  its name for messages.
/// @throws InputError with all that is wrong, line by line.
HorizonTable parse_horizon_csv(const std::string& text, const std::string& given);

}  // namespace faultsim
