#include "simulator/mesh/fault_splits.h"

#include <algorithm>
#include <map>
#include <utility>

#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

/// All faces between cells that touch a node of a fault, with the fault's sides.
std::vector<SharedFace> faces_at_faults(const UncutMesh& body, const CellFaces& faces,
                                        const std::vector<std::vector<FaultFacet>>& facets) {
  std::vector<bool> on_fault(body.nodes.size(), false);
  std::vector<int> fault_of(faces.faces.size(), -1);
  std::vector<std::array<int, 2>> sides(faces.faces.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (const FaultFacet& facet : facets[f]) {
      fault_of[facet.face] = static_cast<int>(f);
      sides[facet.face] = {facet.minus_cell, facet.plus_cell};
      for (const int node : facet.corners)
        if (node >= 0) on_fault[node] = true;
    }
  }
  std::vector<SharedFace> shared;
  for (std::size_t k = 0; k < faces.faces.size(); ++k) {
    const CellFace& face = faces.faces[k];
    if (face.cells[1] < 0) continue;
    if (std::ranges::none_of(face.sorted, [&](int node) { return node >= 0 && on_fault[node]; }))
      continue;
    shared.push_back({face.sorted, fault_of[k] < 0 ? face.cells : sides[k], fault_of[k]});
  }
  return shared;
}

/// Ends of the sides of a triangle, whose corners descend.
std::array<std::pair<int, int>, 3> sides_of(const SharedFace& face) {
  const std::array<int, 4>& at = face.nodes;
  return {{{at[2], at[1]}, {at[1], at[0]}, {at[2], at[0]}}};
}

std::vector<std::pair<int, int>> sides_on_faults(const std::vector<SharedFace>& shared) {
  std::vector<std::pair<int, int>> ends;
  for (const SharedFace& face : shared)
    if (face.fault >= 0)
      for (const auto& side : sides_of(face)) ends.push_back(side);
  std::ranges::sort(ends);
  drop_repeated(ends);
  return ends;
}

/// The faces by their sides that lie on faults, numbers into `ends`, in place of their corners.
std::vector<SharedFace> faces_by_sides(const std::vector<SharedFace>& shared,
                                       const std::vector<std::pair<int, int>>& ends) {
  std::vector<SharedFace> by_sides;
  for (const SharedFace& face : shared) {
    SharedFace one{{-1, -1, -1, -1}, face.cells, face.fault};
    std::size_t n = 0;
    for (const auto& side : sides_of(face)) {
      const auto at = std::ranges::lower_bound(ends, side);
      if (at != ends.end() && *at == side) one.nodes[n++] = static_cast<int>(at - ends.begin());
    }
    if (n > 0) by_sides.push_back(one);
  }
  return by_sides;
}

/// Places by the faults that cut the rock there only together.
using UndecidedPlaces = std::map<std::vector<int>, std::vector<Eigen::Vector3d>>;

/// A problem for each set of faults.
std::vector<Problem> undecided(const UncutMesh& body, const UndecidedPlaces& places) {
  std::vector<Problem> problems;
  for (const auto& [faults, at] : places) {
    std::string names;
    for (const int fault : faults)
      names += concat(names.empty() ? "\"" : ", \"", body.faults[fault].name, "\"");
    problems.push_back({"", 0,
                        concat("the faults ", names, " cut the rock only together, at ",
                               counted(at.size(), "node", "nodes"), ", the first at ",
                               place_text(at.front()), ": a jump there would belong to none"),
                        "let one of them extend beyond the other, or make them one fault"});
  }
  return problems;
}

/// Cells that hang on a split corner by that corner alone belong to no side of the fault.
void find_hanging_cells(const UncutMesh& body, const std::vector<SplitNode>& splits,
                        std::vector<Problem>& problems) {
  const std::size_t n = corners_of_cell(body.shape);
  std::vector<int> split_of(body.nodes.size(), -1);
  for (std::size_t k = 0; k < splits.size(); ++k) split_of[splits[k].node] = static_cast<int>(k);
  for (std::size_t cell = 0; cell < body.n_cells(); ++cell) {
    for (const int node : std::span(body.corners).subspan(n * cell, n)) {
      if (split_of[node] < 0 || sector_of(splits[split_of[node]], static_cast<int>(cell)) >= 0)
        continue;
      problems.push_back(
          {"", 0,
           concat("a cell meets a fault at one corner only, at ", place_text(body.nodes[node])),
           "join it to its neighbours by a face"});
      return;
    }
  }
}

}  // namespace

int sector_of(const SplitNode& node, int cell) {
  for (std::size_t s = 0; s < node.sectors.size(); ++s)
    if (std::ranges::binary_search(node.sectors[s], cell)) return static_cast<int>(s);
  return -1;
}

FaultSplits split_at_faults(const UncutMesh& body, const CellFaces& faces,
                            const std::vector<std::vector<FaultFacet>>& facets,
                            std::vector<Problem>& problems) {
  const std::vector<SharedFace> shared = faces_at_faults(body, faces, facets);
  SplitNodes corners = split_nodes(static_cast<int>(body.nodes.size()), shared);
  UndecidedPlaces places;
  for (const UndecidedNode& node : corners.undecided)
    places[node.faults].push_back(body.nodes[node.node]);
  FaultSplits splits{std::move(corners.split), {}, {}};
  find_hanging_cells(body, splits.corners, problems);
  if (body.shape == CellShape::tetrahedron) {
    splits.side_ends = sides_on_faults(shared);
    SplitNodes sides = split_nodes(static_cast<int>(splits.side_ends.size()),
                                   faces_by_sides(shared, splits.side_ends));
    for (const UndecidedNode& side : sides.undecided) {
      const auto& [a, b] = splits.side_ends[side.node];
      places[side.faults].push_back((body.nodes[a] + body.nodes[b]) / 2);
    }
    splits.sides = std::move(sides.split);
  }
  for (Problem& problem : undecided(body, places)) problems.push_back(std::move(problem));
  return splits;
}

}  // namespace faultsim
