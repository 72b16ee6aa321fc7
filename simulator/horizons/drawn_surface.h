#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::horizons {

/// A fault as interpreters draw it: triangles, or lines down it one beside the other (sticks). m, z
/// up.
struct DrawnSurface {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  /// Points of each line, z falling; neighbours in order. Beyond its ends a stick goes on straight.
  std::vector<std::vector<int>> sticks;
};

/// A line in which a surface is cut by a level plane, by its points.
using LevelLine = std::vector<Eigen::Vector2d>;

/// The lines at a depth, each once. A line that branches is cut in pieces there.
std::vector<LevelLine> level_lines(const DrawnSurface& surface, double z);

/// What a LayeredFault takes of a surface.
struct SurfaceLines {
  std::vector<Eigen::Vector2d> trace;
  std::vector<DipProfile> profiles;  ///< per point of the trace.
  double top = 0, bottom = 0;        ///< z of the surface's highest and lowest point.
  /// z, lowest and highest, to which the surface itself reaches at each point of the trace: within
  /// what depths of profiles are apart, and no less.
  std::vector<std::array<double, 2>> reached;
};

/// The line of a surface at the depth of traces, with points at about the distance `cell`, such
/// that it dips to the right of it (a vertical one: to larger y, then x), and lines down the
/// surface from its points: where the vertical plane across the trace cuts it, at depths `cell`
/// apart. At depths where the surface does not reach a point of the trace, its line goes on
/// straight; where it has none yet, shifts are those of the nearest point that has one.
///
/// Appended to problems, all with place: a surface that the depth of traces does not cut, or in
/// several lines, or in a ring; that is less than a cell long there, or down; that lies in two
/// places at one depth (it folds back).
/// @param trace    the line to be taken, with points between; empty: that of the surface.
/// @param pointer  of the problems. @param name  of the fault.
SurfaceLines lines_of(const DrawnSurface& surface, const std::vector<Eigen::Vector2d>& trace,
                      double trace_depth, double cell, const std::string& pointer,
                      const std::string& name, std::vector<Problem>& problems);

}  // namespace faultsim::horizons
