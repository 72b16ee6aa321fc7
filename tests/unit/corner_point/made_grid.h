#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "simulator/corner_point/corner_point_grid.h"

namespace faultsim::corner_point {

/// A fault of a grid that a test makes: a straight line on the map along which the columns to its
/// right are lower.
struct MadeFault {
  Eigen::Vector2d from = {0, 0}, to = {0, 0};  ///< m, at the height of the grid's reference.
  /// m, > 0: right is lower; of s, 0 at `from` and 1 at `to`, and of what lies before and beyond.
  std::function<double(double)> offset = [](double) { return 0.0; };
  int only_right_of = -1;  ///< a fault: this one is only there to its right.
};

struct MadeGrid {
  std::array<int, 3> size = {20, 16, 3};
  double dx = 100, dy = 80;       ///< m
  double reference = -2000;       ///< m, z: where pillars are at multiples of dx and dy.
  Eigen::Vector2d lean = {0, 0};  ///< m per m downwards, of all pillars.
  std::vector<double> thickness = {10, 20, 15};
  std::vector<MadeFault> faults = {};
  std::vector<std::array<int, 3>> inactive = {};  ///< i, j, k; k < 0: the column.
  bool is_left_handed = false;                    ///< y falls with j.
};

/// The height of the grid's top before faults, m.
double made_top(const Eigen::Vector2d& at);
CornerPointGrid made(const MadeGrid& grid);
/// The same as a file's arrays, in units of `metre` m, depths downwards.
EclipseGrid as_file(const CornerPointGrid& grid, double metre);
/// m, of a point from the line through a segment, and from the segment.
double distance_from_line(const MadeFault& fault, const Eigen::Vector2d& at);
double distance_from(const MadeFault& fault, const Eigen::Vector2d& at);

}  // namespace faultsim::corner_point
