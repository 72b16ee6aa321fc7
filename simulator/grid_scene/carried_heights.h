#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

/// How heights of surfaces of a grid go on from its pillars to a straightened fault. m, z up.
namespace faultsim::grid_scene {

/// Height and slope of a surface.
struct Level {
  double z = 0;
  Eigen::Vector2d slope = {0, 0};
};

/// A surface in the columns of one side of a pillar, before it is moved.
struct Moved {
  Level level;
  Eigen::Vector2d from;             ///< where the pillar is there.
  Eigen::Vector2d across = {0, 0};  ///< the fault that it is on, a unit vector; (0, 0): on none.
};

struct CarriedHeights {
  std::vector<double> z;  ///< per side, m.
  bool is_found = true;   ///< else z is that of the levels.
};

/// Heights of all sides of one pillar where they are moved to. Along the fault each goes on by its
/// own slope, across it all by the mean of their slopes: what lies between the sides, the throw, is
/// kept where the pillar is put on the straightened fault. Exact where places go on linearly with
/// the height, however steeply a surface falls along the way of the pillar. None may be found where
/// it rises faster than the pillar does, or where places jump.
/// @param place  where one of them is at a height; none: it is not moved.
CarriedHeights carried(
    const std::vector<Moved>& sides,
    const std::function<std::optional<Eigen::Vector2d>(std::size_t side, double z)>& place);

/// A surface along one side of a fault, linear between points.
class SideProfile {
 public:
  /// @param along  m; points in any order.
  void add(double along, double z);
  /// None before the first and after the last point.
  std::optional<double> at(double along) const;

 private:
  std::vector<std::pair<double, double>> points_;  ///< in order along the fault.
};

/// A surface along the sides of all faults.
class SideProfiles {
 public:
  /// @param side  1 left, −1 right.
  void add(int fault, int side, double along, double z) { of_side_[{fault, side}].add(along, z); }
  /// None as of a SideProfile, and of a side without any point.
  std::optional<double> at(int fault, int side, double along) const;

 private:
  std::map<std::pair<int, int>, SideProfile> of_side_;  ///< by fault and side.
};

}  // namespace faultsim::grid_scene
