#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/mesh/fault_splits.h"
#include "simulator/mesh/hat_areas.h"
#include "simulator/mesh/uncut_mesh.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using NodePair = std::pair<int, int>;

/// A node that is cut, with the number of each sector's copy and what it moves with.
struct CutNode {
  std::vector<std::vector<int>> sectors;
  std::vector<int> copies;
  std::vector<std::vector<JumpShare>> shares;

  /// Of a cell around it.
  std::size_t sector(int cell) const {
    std::size_t s = 0;
    while (!std::ranges::binary_search(sectors.at(s), cell)) ++s;
    return s;
  }
};

/// Which jump of a fault lies between two sectors.
int jump_between(const SplitNode& node, int fault, int minus, int plus) {
  for (std::size_t j = 0; j < node.jumps.size(); ++j) {
    const NodeJump& jump = node.jumps[j];
    if (jump.fault == fault && contains(jump.minus, minus) && contains(jump.plus, plus))
      return static_cast<int>(j);
  }
  return -1;
}

/// What a sector of a node has of the facets towards another one, m2 of the hat.
struct SectorArea {
  int sector, beyond;
  double area;
};

/// Makes a Mesh from a body whose facets are known to be sound.
class Cutter {
 public:
  Cutter(const UncutMesh& body, const std::vector<std::vector<FaultFacet>>& facets,
         const FaultSplits& splits)
      : body_(body), facets_(facets), splits_(splits) {
    mesh_.cells = Cells(body.shape);
  }

  Mesh finish(const std::vector<std::vector<CellFace>>& boundary);

 private:
  bool is_tetrahedral() const { return body_.shape == CellShape::tetrahedron; }
  std::span<const int> corners(int cell) const {
    const std::size_t n = corners_of_cell(body_.shape);
    return std::span(body_.corners).subspan(n * static_cast<std::size_t>(cell), n);
  }
  void number_sides();
  void add_surface(std::size_t fault);
  int jump_of(int fault, const FaultFacet& facet, std::size_t corner, double area);
  void align_with_outside(std::size_t fault);
  void find_outside(const std::vector<std::vector<CellFace>>& boundary);
  void add_jumps(std::size_t fault);
  int point_of(FaultSurface& surface, std::map<NodePair, int>& points, int node, int jump);
  void copy_corners();
  void copy_middles();
  void place_copies(int node, CutNode& cut);
  void add_cells();
  void add_boundary(const std::vector<std::vector<CellFace>>& boundary);
  std::vector<JumpShare> shares_at(int node, int cell) const;
  std::pair<double, double> weights(const SplitNode& node, const NodeJump& jump) const;

  const UncutMesh& body_;
  const std::vector<std::vector<FaultFacet>>& facets_;
  const FaultSplits& splits_;
  std::map<int, std::vector<int>> axes_across_outside_;  ///< by corner: of plane sides there.
  std::map<NodePair, int> middles_;                      ///< of all sides of tetrahedra: the node.
  std::map<std::pair<int, int>, int>
      number_;  ///< (node, jump at it): into its FaultSurface::nodes.
  std::map<int, std::vector<SectorArea>> areas_;  ///< by node.
  std::map<int, CutNode> cut_;                    ///< by node, corners and middles.
  Mesh mesh_;
};

/// Nodes in the middle of the sides of tetrahedra, behind the corners.
void Cutter::number_sides() {
  std::vector<NodePair> sides;
  for (std::size_t cell = 0; cell < body_.n_cells(); ++cell) {
    const std::span<const int> at = corners(static_cast<int>(cell));
    for (const auto& [a, b] : kTetrahedronSides) sides.push_back(std::minmax(at[a], at[b]));
  }
  std::ranges::sort(sides);
  drop_repeated(sides);
  for (const NodePair& side : sides) {
    middles_.emplace_hint(middles_.end(), side, static_cast<int>(mesh_.nodes.size()));
    mesh_.nodes.push_back((body_.nodes[side.first] + body_.nodes[side.second]) / 2);
  }
}

/// The jumps of a fault become the nodes of its surface, by node.
void Cutter::add_jumps(std::size_t fault) {
  FaultSurface& surface = mesh_.faults[fault];
  for (const SplitNode& node : splits_.corners) {
    for (std::size_t j = 0; j < node.jumps.size(); ++j) {
      if (node.jumps[j].fault != static_cast<int>(fault)) continue;
      number_.emplace(std::pair(node.node, static_cast<int>(j)),
                      static_cast<int>(surface.nodes.size()));
      surface.nodes.push_back({-1, -1, Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), 0});
    }
  }
}

int Cutter::point_of(FaultSurface& surface, std::map<NodePair, int>& points, int node, int jump) {
  const auto [at, is_new] =
      points.emplace(NodePair(node, jump), static_cast<int>(surface.points.size()));
  if (is_new) {
    surface.points.push_back(body_.nodes[node]);
    surface.node_of_point.push_back(jump < 0 ? -1 : number_.at({node, jump}));
  }
  return at->second;
}

/// The rest of a node's frame by its normal.
void set_frame(FaultNode& node) {
  constexpr double kHorizontal = 1e-9;
  const Vector3d across = node.normal.cross(Vector3d::UnitZ());
  node.strike = across.norm() > kHorizontal ? across.normalized() : Vector3d::UnitX();
  node.dip = node.normal.cross(node.strike);
}

/// The jump of a facet at a corner; notes what the sectors there have of the facet.
int Cutter::jump_of(int fault, const FaultFacet& facet, std::size_t corner, double area) {
  const int number = facet.corners[corner];
  const auto node = std::ranges::lower_bound(splits_.corners, number, {}, &SplitNode::node);
  if (node == splits_.corners.end() || node->node != number) return -1;
  const int minus = sector_of(*node, facet.minus_cell), plus = sector_of(*node, facet.plus_cell);
  if (minus == plus) return -1;
  areas_[number].push_back({minus, plus, area});
  areas_[number].push_back({plus, minus, area});
  return jump_between(*node, fault, minus, plus);
}

void Cutter::add_surface(std::size_t fault) {
  FaultSurface& surface = mesh_.faults[fault];
  std::map<NodePair, int> points;
  for (const FaultFacet& facet : facets_[fault]) {
    FaultFace face{{-1, -1, -1, -1}, {-1, -1, -1, -1}, facet.minus_cell, facet.plus_cell, 0};
    const std::size_t n = facet.corners[3] < 0 ? 3 : 4;
    const auto at = [&](std::size_t v) -> const Vector3d& { return body_.nodes[facet.corners[v]]; };
    const HatAreas areas =
        n == 3 ? triangle_areas({at(0), at(1), at(2)}) : quad_areas({at(0), at(1), at(2), at(3)});
    const Vector3d area = area_vector(body_.nodes, facet.corners);
    face.area = areas.total;
    for (std::size_t v = 0; v < n; ++v) {
      const int jump = jump_of(static_cast<int>(fault), facet, v, areas.corner[v]);
      face.points[v] = point_of(surface, points, facet.corners[v], jump);
      face.nodes[v] = surface.node_of_point[face.points[v]];
      if (face.nodes[v] < 0) continue;
      surface.nodes[face.nodes[v]].area += areas.corner[v];
      surface.nodes[face.nodes[v]].normal += area;
    }
    surface.faces.push_back(face);
  }
  for (FaultNode& node : surface.nodes) node.normal.normalize();
  align_with_outside(fault);
  for (FaultNode& node : surface.nodes) set_frame(node);
}

/// Where a curved fault meets a plane side of the body at a right angle, the mean over the facets
/// on one side of it is off by no more than the facets differ: the normal is turned into the plane.
void Cutter::align_with_outside(std::size_t fault) {
  FaultSurface& surface = mesh_.faults[fault];
  std::vector<double> spread(surface.nodes.size(), 0);
  std::vector<int> place(surface.nodes.size(), -1);
  for (std::size_t k = 0; k < surface.faces.size(); ++k) {
    const FaultFacet& facet = facets_[fault][k];
    const Vector3d normal = area_vector(body_.nodes, facet.corners).normalized();
    for (std::size_t v = 0; v < surface.faces[k].n_corners(); ++v) {
      const int node = surface.faces[k].nodes[v];
      if (node < 0) continue;
      spread[node] = std::max(spread[node], (normal - surface.nodes[node].normal).norm());
      place[node] = facet.corners[v];
    }
  }
  for (std::size_t k = 0; k < surface.nodes.size(); ++k) {
    Vector3d& normal = surface.nodes[k].normal;
    for (const int axis : axes_across_outside_[place[k]])
      if (std::abs(normal[axis]) <= spread[k]) normal[axis] = 0;
    normal.normalize();
  }
}

/// Numbers the copies of a node; the first sector's keeps its number.
void Cutter::place_copies(int node, CutNode& cut) {
  for (std::size_t s = 0; s < cut.sectors.size(); ++s) {
    int copy = node;
    if (s > 0) {
      copy = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.push_back(Vector3d(mesh_.nodes[node]));
    }
    cut.copies.push_back(copy);
    mesh_.copies.push_back({copy, node, cut.shares[s]});
  }
}

/// How far both sides of a jump move of it, together 1. Half each; but where the jump is within one
/// side of a fault that goes on, so that the mean of that side over the fault's area around the
/// node stays, and an even traction of that fault does no work with the jump. Where several go on
/// (a point where three meet) their areas are added up, and the jump's traction holds a part of
/// theirs.
std::pair<double, double> Cutter::weights(const SplitNode& node, const NodeJump& jump) const {
  double below = 0, above = 0;
  for (const SectorArea& one : areas_.at(node.node)) {
    if (contains(jump.minus, one.beyond) || contains(jump.plus, one.beyond)) continue;
    if (contains(jump.minus, one.sector)) below += one.area;
    if (contains(jump.plus, one.sector)) above += one.area;
  }
  if (below + above == 0) return {0.5, 0.5};
  return {above / (below + above), below / (below + above)};
}

void Cutter::copy_corners() {
  for (const SplitNode& node : splits_.corners) {
    CutNode cut{node.sectors, {}, std::vector<std::vector<JumpShare>>(node.sectors.size())};
    for (std::size_t j = 0; j < node.jumps.size(); ++j) {
      const NodeJump& jump = node.jumps[j];
      const int number = number_.at({node.node, static_cast<int>(j)});
      const auto [below, above] = weights(node, jump);
      for (const int s : jump.minus) cut.shares[s].push_back({jump.fault, number, -below});
      for (const int s : jump.plus) cut.shares[s].push_back({jump.fault, number, above});
    }
    place_copies(node.node, cut);
    for (std::size_t j = 0; j < node.jumps.size(); ++j) {
      const NodeJump& jump = node.jumps[j];
      FaultNode& own = mesh_.faults[jump.fault].nodes[number_.at({node.node, static_cast<int>(j)})];
      own.minus_node = cut.copies[jump.minus.front()];
      own.plus_node = cut.copies[jump.plus.front()];
    }
    cut_.emplace(node.node, std::move(cut));
  }
}

/// What the copy of a node that a cell has moves with.
std::vector<JumpShare> Cutter::shares_at(int node, int cell) const {
  const auto at = cut_.find(node);
  return at == cut_.end() ? std::vector<JumpShare>() : at->second.shares[at->second.sector(cell)];
}

void Cutter::copy_middles() {
  for (const SplitNode& edge : splits_.sides) {
    const NodePair& ends = splits_.side_ends[edge.node];
    CutNode cut{edge.sectors, {}, {}};
    for (const std::vector<int>& sector : edge.sectors) {
      std::vector<JumpShare> shares;
      for (const int end : {ends.first, ends.second}) {
        for (JumpShare share : shares_at(end, sector.front())) {
          share.weight /= 2;
          shares.push_back(share);
        }
      }
      cut.shares.push_back(std::move(shares));
    }
    const int node = middles_.at(ends);
    place_copies(node, cut);
    cut_.emplace(node, std::move(cut));
  }
}

void Cutter::add_cells() {
  std::vector<int> nodes;
  mesh_.cells.reserve(body_.n_cells());
  for (std::size_t cell = 0; cell < body_.n_cells(); ++cell) {
    const std::span<const int> at = corners(static_cast<int>(cell));
    nodes.assign(at.begin(), at.end());
    if (is_tetrahedral())
      for (const auto& [a, b] : kTetrahedronSides)
        nodes.push_back(middles_.at(std::minmax(at[a], at[b])));
    for (int& node : nodes) {
      const auto cut = cut_.find(node);
      if (cut != cut_.end()) node = cut->second.copies[cut->second.sector(static_cast<int>(cell))];
    }
    mesh_.cells.add(nodes);
  }
}

void Cutter::add_boundary(const std::vector<std::vector<CellFace>>& boundary) {
  for (std::size_t group = 0; group < boundary.size(); ++group) {
    for (const CellFace& face : boundary[group]) {
      const int cell = face.cells[0];
      BoundaryFace one{cell, BoundaryGroup(static_cast<int>(group)), {-1, -1, -1, -1, -1, -1}};
      const std::span<const int> nodes = mesh_.cells[static_cast<std::size_t>(cell)];
      if (is_tetrahedral()) {
        for (std::size_t v = 0; v < 6; ++v)
          one.places[v] = nodes[kTetrahedronFaces[face.place[0]][v]];
      } else {
        std::ranges::copy(corners_of_face(body_.shape, nodes, face.place[0]), one.places.begin());
      }
      mesh_.boundary.push_back(one);
    }
  }
}

void Cutter::find_outside(const std::vector<std::vector<CellFace>>& boundary) {
  constexpr double kPlane = 1e-9;
  for (const std::vector<CellFace>& group : boundary) {
    for (const CellFace& face : group) {
      const Vector3d normal =
          area_vector(body_.nodes,
                      corners_of_face(body_.shape, corners(face.cells[0]), face.place[0]))
              .normalized();
      Eigen::Index axis = 0;
      if (1 - normal.cwiseAbs().maxCoeff(&axis) > kPlane) continue;
      for (const int node : face.sorted) {
        if (node < 0) continue;
        std::vector<int>& axes = axes_across_outside_[node];
        if (!contains(axes, static_cast<int>(axis))) axes.push_back(static_cast<int>(axis));
      }
    }
  }
}

Mesh Cutter::finish(const std::vector<std::vector<CellFace>>& boundary) {
  mesh_.nodes = body_.nodes;
  mesh_.material = body_.material;
  mesh_.region = body_.region;
  mesh_.region_fraction = body_.region_fraction;
  if (is_tetrahedral()) number_sides();
  find_outside(boundary);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    mesh_.faults.emplace_back().name = body_.faults[f].name;
    add_jumps(f);
    add_surface(f);
  }
  copy_corners();
  copy_middles();
  std::ranges::sort(mesh_.copies, {}, &NodeCopy::node);
  add_cells();
  add_boundary(boundary);
  for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) mesh_.tied_to.push_back(static_cast<int>(n));
  return std::move(mesh_);
}

void demand_whole(const UncutMesh& body) {
  const std::size_t n = body.n_cells();
  FAULTSIM_DEMAND(body.corners.size() == n * corners_of_cell(body.shape) &&
                      body.region.size() == n && body.region_fraction.size() == n,
                  body.corners.size(), " corners of ", n, " cells");
}

}  // namespace

Mesh cut(const UncutMesh& body, const std::string& source) {
  demand_whole(body);
  std::vector<Problem> problems;
  const CellFaces faces = match_faces(body.shape, body.corners);
  if (!faces.overlapping.empty())
    problems.push_back({"", 0,
                        concat(counted(faces.overlapping.size(), "face is", "faces are"),
                               " of more than two cells, the first at ",
                               place_of(body.nodes, faces.overlapping.front())),
                        "let the volumes fit together without overlapping"});
  const std::vector<std::vector<FaultFacet>> facets = fault_facets(body, faces, problems);
  const std::vector<std::vector<CellFace>> boundary = boundary_facets(body, faces, problems);
  if (!problems.empty()) throw InputError(source, problems);
  const FaultSplits splits = split_at_faults(body, faces, facets, problems);
  if (!problems.empty()) throw InputError(source, problems);
  return Cutter(body, facets, splits).finish(boundary);
}

}  // namespace faultsim
