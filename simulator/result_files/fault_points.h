#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_operator.h"

/// For this folder: a fault as its pictures show it, whole where only half of the domain is
/// modelled.
namespace faultsim {

/// The points of a fault that are shown, and where their values come from.
struct FaultPoints {
  std::vector<int> source;       ///< node of the point; unsplit: of the nearest split one or -1.
  std::vector<int> split;        ///< 1 where the point is split.
  std::vector<char> mirrored;    ///< 1: its values are the mirror image of its node's.
  std::vector<double> share;     ///< area of the point over that of its node: 2 on the plane that
                                 ///< halves the domain, else 1.
  std::vector<double> position;  ///< x 3
  std::vector<int> cells;
  std::size_t points_per_cell = 4;  ///< in plane strain 2.
};

/// All points of a fault: where only y ≥ 0 is modelled, the other half as its mirror image, from
/// the far end towards the plane.
FaultPoints collect_points(const OperatorFault& fault, const FaultGeometry& geometry);

/// The node of a point with the frame that it has there. @pre points.source[i] >= 0
OperatorNode node_of(const std::vector<OperatorNode>& nodes, const FaultPoints& points,
                     std::size_t i);

/// Components along normal, strike and dip of a node in the frame of its point.
Eigen::Vector3d as_seen(const Eigen::Vector3d& local, bool mirrored);

}  // namespace faultsim
