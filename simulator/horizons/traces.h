#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::horizons {

/// A line of the map by its points. Where lines meet, both have exactly the same point.
struct MapLine {
  std::string name;
  std::vector<Eigen::Vector2d> points;
  std::vector<bool> is_kept;  ///< per point: ends, meeting points, bends.
};

/// Lines that meet where they should: the faults in their order, then the dividers.
struct MapLines {
  std::vector<MapLine> lines;
  int n_faults = 0;

  bool is_fault(int line) const { return line < n_faults; }
};

/// Joins ends at faults and at the box, finds crossings and takes points along each fault at about
/// the distance `cells.at_faults`; dividers keep theirs. What cannot be is appended to problems,
/// with its place: traces without length or outside of the box, ends that are near nothing they
/// could end at, ends in the rock closer than a cell to another line, two faults that end at each
/// other (V), lines that meet at less than 25 degrees or closer to the next meeting point than half
/// a cell.
MapLines meeting_lines(const LayeredBody& body, std::vector<Problem>& problems);

/// "x 10, y 20 m".
std::string map_place(const Eigen::Vector2d& at);

/// The nearest point of a line to a place.
struct NearestOnLine {
  double distance;
  Eigen::Vector2d point;
  std::size_t segment;  ///< from points[segment] on.
};
NearestOnLine nearest_on_line(const std::vector<Eigen::Vector2d>& line,
                              const Eigen::Vector2d& place);

/// Where two stretches cross, ends included; NaN if they do not.
Eigen::Vector2d crossing_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c, const Eigen::Vector2d& d);

}  // namespace faultsim::horizons
