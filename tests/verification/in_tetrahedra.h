#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "simulator/mesh/uncut_mesh.h"

namespace faultsim::test {

/// The body of a mesh of hexahedra before its faults were cut, each cell as six tetrahedra around a
/// diagonal: that from the lowest to the highest corner, or the one mirrored in x. Boundary groups
/// are the sides. Ties are left out.
class InTetrahedra {
 public:
  explicit InTetrahedra(const Mesh& mesh, bool is_mirrored = false)
      : mesh_(mesh), is_mirrored_(is_mirrored) {
    merge_copies();
  }

  UncutMesh body() {
    for (const std::vector<int>& path : paths())
      for (std::size_t cell = 0; cell < mesh_.cells.size(); ++cell) add(cell, path);
    for (const FaultSurface& fault : mesh_.faults) {
      FacetGroup group{fault.name, {}};
      for (const FaultFace& face : fault.faces)
        add_facets(face.minus_cell, common(face.minus_cell, face.plus_cell), group);
      body_.faults.push_back(group);
    }
    for (const char* side : {"x-", "x+", "y-", "y+", "z-", "z+"})
      body_.boundary.push_back({side, {}});
    for (const BoundaryFace& face : mesh_.boundary) {
      std::set<int> corners;
      for (const int node : face.nodes()) corners.insert(merged_[node]);
      add_facets(face.cell, corners, body_.boundary[static_cast<std::size_t>(face.group.index)]);
    }
    return body_;
  }

 private:
  void merge_copies() {
    std::map<std::tuple<double, double, double>, int> at;
    for (const Eigen::Vector3d& x : mesh_.nodes) {
      const auto [found, is_new] =
          at.emplace(std::tuple(x.x(), x.y(), x.z()), static_cast<int>(body_.nodes.size()));
      if (is_new) body_.nodes.push_back(x);
      merged_.push_back(found->second);
    }
  }

  /// From one corner of a hexahedron to the opposite one, along each order of its axes.
  std::vector<std::vector<int>> paths() const {
    if (is_mirrored_)
      return {{1, 0, 3, 7}, {1, 0, 4, 7}, {1, 2, 3, 7}, {1, 2, 6, 7}, {1, 5, 4, 7}, {1, 5, 6, 7}};
    return {{0, 1, 2, 6}, {0, 1, 5, 6}, {0, 3, 2, 6}, {0, 3, 7, 6}, {0, 4, 5, 6}, {0, 4, 7, 6}};
  }

  void add(std::size_t cell, const std::vector<int>& path) {
    std::array<int, 4> corners{};
    for (std::size_t v = 0; v < 4; ++v)
      corners[v] = merged_[mesh_.cells[cell][static_cast<std::size_t>(path[v])]];
    const auto edge = [&](std::size_t v) -> Eigen::Vector3d {
      return body_.nodes[corners[v]] - body_.nodes[corners[0]];
    };
    if (edge(1).cross(edge(2)).dot(edge(3)) < 0) std::swap(corners[2], corners[3]);
    body_.corners.insert(body_.corners.end(), corners.begin(), corners.end());
    body_.material.push_back(mesh_.material[cell]);
    body_.region.push_back(mesh_.region[cell]);
    body_.region_fraction.push_back(mesh_.region_fraction[cell]);
  }

  std::set<int> common(int a, int b) const {
    std::set<int> of_a, both;
    for (const int node : mesh_.cells[a]) of_a.insert(merged_[node]);
    for (const int node : mesh_.cells[b])
      if (of_a.contains(merged_[node])) both.insert(merged_[node]);
    return both;
  }

  /// The faces of a cell's tetrahedra that lie in one of its own faces.
  void add_facets(int cell, const std::set<int>& corners, FacetGroup& group) const {
    const std::size_t n_cells = mesh_.cells.size();
    for (std::size_t part = 0; part < 6; ++part) {
      const int* at = &body_.corners[4 * (part * n_cells + static_cast<std::size_t>(cell))];
      std::array<int, 4> facet = {-1, -1, -1, -1};
      std::size_t n = 0;
      for (std::size_t v = 0; v < 4; ++v)
        if (corners.contains(at[v])) facet[n++] = at[v];
      if (n == 3) group.facets.push_back(facet);
    }
  }

  const Mesh& mesh_;
  bool is_mirrored_;
  std::vector<int> merged_;
  UncutMesh body_;
};

}  // namespace faultsim::test
