#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "simulator/mesh/cells.h"
#include "simulator/scene/geometry.h"

namespace faultsim {

/// Faces of the boundary by name: of a grid its sides, in their order.
struct BoundaryGroup {
  BoundaryGroup(Side side) : index(static_cast<int>(side)) {}
  explicit BoundaryGroup(int number) : index(number) {}
  bool operator==(const BoundaryGroup&) const = default;
  int index;
};

/// A face of a cell on the boundary of the body.
struct BoundaryFace {
  int cell;
  BoundaryGroup group;
  /// Corners, counter-clockwise seen from outside; of a tetrahedron then the middles of its sides
  /// 01, 12, 20. −1 behind the last.
  std::array<int, 6> places;

  std::span<const int> nodes() const {
    return std::span(places).first(places[4] < 0 ? std::size_t{4} : std::size_t{6});
  }
};

/// A duplicated node of a fault: two mesh nodes at one place.
///
/// n points from the minus to the plus side; (n, strike, dip) is right-handed: dip = n × strike.
/// Strike is horizontal, dip points down where the fault is not horizontal. For a horizontal
/// fault n = +z, strike = the patch's strike direction.
struct FaultNode {
  int minus_node;  ///< mesh node on the minus side (the side that n leaves).
  int plus_node;
  Eigen::Vector3d normal;
  Eigen::Vector3d strike;
  Eigen::Vector3d dip;
  double area;  ///< A_k, m2: of each fault face around it that lies in the patch the integral of
                ///< its (bi)linear hat; in plane strain per metre of strike.
};

/// A share of the jump at a node of a fault.
struct JumpShare {
  int fault;
  int node;  ///< into FaultSurface::nodes.
  double weight;
};

/// One of the copies into which faults cut a node. All copies at a place share a mean displacement
/// ū, and each moves with shares of jumps besides: u = ū + Σ weight R_k g_k. A node in the middle
/// of a side has half of what both ends of the side have on its side of the faults: jumps are
/// linear along it.
struct NodeCopy {
  int node;
  int first;  ///< the lowest copy at its place.
  std::vector<JumpShare> shares;
};

/// A face of a fault, of three or four corners.
struct FaultFace {
  std::array<int, 4> points;  ///< of its corners, cyclic, into FaultSurface::points; −1 of a fourth
                              ///< that a triangle has not.
  std::array<int, 4> nodes;  ///< of its corners, into FaultSurface::nodes; −1 where not split.
  int minus_cell;
  int plus_cell;
  double area;  ///< m2 (plane strain: per metre of strike).

  std::size_t n_corners() const { return points[3] < 0 ? 3 : 4; }
};

/// A fault as a surface of points and faces. In plane strain a face is an edge down dip, whose ends
/// it has twice: corners 0 and 3, and 1 and 2, are the same point. On tied faces several points
/// share one node.
struct FaultSurface {
  std::string name;
  std::vector<Eigen::Vector3d> points;  ///< m, each the corner of a face.
  std::vector<int> node_of_point;       ///< into nodes, -1 where the point is not split.
  std::vector<FaultNode> nodes;         ///< one per *independent* duplicated node (ties merged).
  std::vector<FaultFace> faces;
};

/// Conforming cells with copied nodes on the faults.
struct Mesh {
  std::vector<Eigen::Vector3d> nodes;  ///< m; n_nodes, all copies of a node that is cut.
  Cells cells;
  std::vector<int> material;            ///< per cell, index given by the spec.
  std::vector<int> region;              ///< per cell, pressure region or -1.
  std::vector<double> region_fraction;  ///< per cell, share of its volume in the region, [0, 1].
  std::vector<BoundaryFace> boundary;
  std::vector<int> tied_to;  ///< per node: the node whose displacement it shares (itself
                             ///< when independent). Never a chain.
  std::vector<FaultSurface> faults;
  std::vector<NodeCopy> copies;  ///< by node, ascending.
  bool plane_strain = false;     ///< front and back tied, u_y = 0; thickness is then...
  double thickness = 1;          ///< ... the extent in y of the single cell row, m.
};

/// Fills Mesh::copies where every node of a fault has two, which move with ∓ half of its jump.
void share_pairs(Mesh& mesh);

/// Quality of the worst cells; `refusal` is empty when the mesh may be used.
struct MeshQuality {
  double min_scaled_jacobian = 1;  ///< over cells, at the corners, in (0, 1] for valid cells.
  double max_aspect = 1;           ///< longest over shortest edge.
  Eigen::Vector3d worst_position = Eigen::Vector3d::Zero();
  std::string refusal;  ///< what is wrong, where, and the cure.
};

MeshQuality check_quality(const Mesh& mesh);

/// The mesh node whose displacement stands for that of a point: the nearest.
int observed_node(const Mesh& mesh, const Eigen::Vector3d& point);

}  // namespace faultsim
