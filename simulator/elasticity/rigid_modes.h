#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "simulator/mesh/mesh.h"

namespace faultsim {

/// Pieces into which the faults cut the body (cells that share mesh nodes, ties included).
struct Pieces {
  int n_pieces = 0;
  std::vector<int> of_node;  ///< per mesh node; pieces are numbered by their first cell.
  std::vector<int> n_cells;  ///< per piece.
  std::vector<int> body;     ///< per piece: faults hold the pieces of one body together.
  int n_bodies = 0;
};

Pieces find_pieces(const Mesh& mesh);

/// The box around the mesh nodes that are members; empty without one.
Eigen::AlignedBox3d extent_of(const Mesh& mesh, const std::function<bool(int)>& member);

/// The rigid motions of a set of nodes, u(x) = t + ω x (x − centre)/size, that ties, plane strain
/// and fixed components allow: columns of `free` are (t, ω), orthonormal, 6 x n_free.
struct RigidModes {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double size = 1;  ///< m, half the diagonal of the box around the nodes.
  Eigen::Matrix<double, 6, Eigen::Dynamic> free;

  /// u(x) of the six motions, 3 x 6.
  Eigen::Matrix<double, 3, 6> at(const Eigen::Vector3d& x) const;
};

/// @param member    whether a mesh node belongs to the set.
/// @param is_fixed  whether component c of a mesh node is prescribed.
RigidModes rigid_modes(const Mesh& mesh, const std::function<bool(int)>& member,
                       const std::function<bool(int, int)>& is_fixed);

/// "move along x and turn about z", for messages; "" when nothing is free.
std::string describe(const RigidModes& modes);

}  // namespace faultsim
