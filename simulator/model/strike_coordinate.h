#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace faultsim {

/// How far along its strike each point of a surface lies, which may bend.
struct StrikeCoordinate {
  std::vector<double> along;  ///< s per point, m.
  std::vector<int> part;      ///< per point: connected_parts().
  Eigen::Vector3d mean;       ///< unit vector of the mean strike over the area of all parts.
};

/// The s whose gradient is closest to the strike of the surface everywhere: the least of
/// ∫ |∇s − (n × z)/|n × z||² over its area, by linear elements. Of a vertical surface it is the
/// length along its trace, of a plane one the projection onto its strike. In each part s increases
/// northward, or eastward if the mean strike is nearer to that, and its mean is that of the
/// positions along the part's mean strike. A part without area (lines down dip) has s = 0.
///
/// Which side of a face is first does not matter; parts that can be oriented (no Möbius strips) are
/// needed.
/// @param faces  of points, cyclic; corners may be there twice, as in OperatorFault::faces.
StrikeCoordinate strike_coordinate(std::span<const Eigen::Vector3d> points,
                                   std::span<const std::array<int, 4>> faces);

/// Per point: points that faces connect are one part, counted from 0.
std::vector<int> connected_parts(std::size_t n_points, std::span<const std::array<int, 4>> faces);

/// Whether a horizontal direction points north, or east if it is nearer to that.
bool is_northward(const Eigen::Vector3d& strike);

}  // namespace faultsim
