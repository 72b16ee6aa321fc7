#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "simulator/mesh/sectors.h"

/// Meshes of triangles and of tetrahedra.
namespace faultsim::test {

/// Triangles (of three corners) or tetrahedra, with the faults of their shared faces.
struct Simplices {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::vector<int>> cells;
  std::vector<SharedFace> faces;

  int n_nodes() const { return static_cast<int>(nodes.size()); }
  Eigen::Vector3d centre(std::span<const int> of) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int n = 0;
    for (const int node : of) {
      if (node < 0) continue;
      sum += nodes[node];
      ++n;
    }
    return sum / n;
  }
  Eigen::Vector3d centre_of_cell(int cell) const { return centre(cells[cell]); }
};

/// Fills `faces` with what two cells share.
inline void find_faces(Simplices& mesh) {
  std::map<std::vector<int>, std::vector<int>> cells_of;
  for (int c = 0; c < std::ssize(mesh.cells); ++c)
    for (const int left_out : mesh.cells[c]) {
      std::vector<int> face = mesh.cells[c];
      std::erase(face, left_out);
      std::ranges::sort(face);
      cells_of[face].push_back(c);
    }
  for (const auto& [nodes, cells] : cells_of) {
    if (cells.size() != 2) continue;
    SharedFace face{{-1, -1, -1, -1}, {cells[0], cells[1]}};
    std::ranges::copy(nodes, face.nodes.begin());
    mesh.faces.push_back(face);
  }
}

/// A square of n × n, or a cube of n × n × n, in cells of 1, each of simplices that share a
/// diagonal.
inline Simplices made_of(int n, int dimensions) {
  Simplices mesh;
  const int layers = dimensions == 3 ? n : 0;
  const auto number = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.nodes.emplace_back(i, j, k);
  // Along each order of the axes from the low corner of a cell to its high one.
  std::vector<int> axes(dimensions);
  for (int k = 0; k < std::max(layers, 1); ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        std::iota(axes.begin(), axes.end(), 0);
        do {
          std::array<int, 3> at = {i, j, k};
          std::vector<int> cell = {number(i, j, k)};
          for (const int axis : axes) {
            ++at[axis];
            cell.push_back(number(at[0], at[1], at[2]));
          }
          mesh.cells.push_back(cell);
        } while (std::ranges::next_permutation(axes).found);
      }
  find_faces(mesh);
  return mesh;
}

}  // namespace faultsim::test
