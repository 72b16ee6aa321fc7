#pragma once

#include <cmath>
#include <random>
#include <utility>

#include "tests/unit/mesh/simplices.h"

/// Faults that are parts of planes, in meshes of simplices.
namespace faultsim::test {

/// Faces between cells on different sides of a plane, whose centres a condition holds of.
template <typename Condition>
void add_fault(Simplices& mesh, int fault, const Eigen::Vector3d& normal, double distance,
               const Condition& is_inside) {
  for (SharedFace& face : mesh.faces) {
    const auto beyond = [&](int cell) { return mesh.centre_of_cell(cell).dot(normal) > distance; };
    if (beyond(face.cells[0]) == beyond(face.cells[1]) || face.fault >= 0 ||
        !is_inside(mesh.centre(face.nodes)))
      continue;
    face.fault = fault;
    if (beyond(face.cells[0])) std::swap(face.cells[0], face.cells[1]);
  }
}

inline bool everywhere(const Eigen::Vector3d&) { return true; }

/// Directions in which planes of whole distances consist of faces of such cells.
inline const std::array<Eigen::Vector3d, 6> kNormals = {
    {{1, 0, 0}, {0, 1, 0}, {1, -1, 0}, {0, 0, 1}, {1, 0, -1}, {0, 1, -1}}};

/// Parts of such planes with straight edges: faults that end, cross, end at each other, share
/// faces.
inline void add_random_faults(Simplices& mesh, int n, int n_faults, int dimensions,
                              std::mt19937& random) {
  std::uniform_int_distribution<std::size_t> direction(0, dimensions == 2 ? 2 : 5);
  std::uniform_int_distribution<int> place(1, n - 1), turned(0, 1);
  for (int fault = 0; fault < n_faults; ++fault) {
    const auto whole_distance = [&](const Eigen::Vector3d& normal) {
      return std::round(normal.dot(Eigen::Vector3d(place(random), place(random), place(random))));
    };
    Eigen::Vector3d normal = kNormals[direction(random)];
    double distance = whole_distance(normal);
    if (turned(random) == 1) normal *= -1, distance *= -1;
    std::vector<std::pair<Eigen::Vector3d, double>> edges;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d across = (turned(random) == 1 ? 1 : -1) * kNormals[direction(random)];
      edges.emplace_back(across, whole_distance(across));
    }
    add_fault(mesh, fault, normal, distance, [&](const Eigen::Vector3d& x) {
      return std::ranges::all_of(edges,
                                 [&](const auto& edge) { return edge.first.dot(x) > edge.second; });
    });
  }
}

}  // namespace faultsim::test
