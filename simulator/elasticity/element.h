#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "simulator/elasticity/elasticity.h"

namespace faultsim {

/// Shape function gradients of a cell at its Gauss points.
template <int Nodes, int Points>
struct CellElement {
  static constexpr int kNodes = Nodes, kPoints = Points;
  /// Per Gauss point, dN_a/dx_i, 1/m.
  std::array<Eigen::Matrix<double, Nodes, 3>, static_cast<std::size_t>(Points)> gradient;
  std::array<double, static_cast<std::size_t>(Points)> weight;  ///< of volume, m3.
  Eigen::Matrix<double, Nodes, 3> mean_gradient;  ///< volume averages of the gradients.
  double volume = 0;                              ///< m3.
};

using Element = CellElement<8, 8>;  ///< a trilinear hexahedron, 2x2x2 points.
/// A quadratic tetrahedron, nodes in VTK order: 0–3 the corners, (1−0) × (2−0) · (3−0) > 0, then
/// the sides 01, 12, 20, 03, 13, 23. Four points: exact where mid-side nodes are in the middle.
using Tetrahedron = CellElement<10, 4>;

/// Rows 3 a + component, a = node.
template <int Nodes>
using CellMatrix = Eigen::Matrix<double, 3 * Nodes, 3 * Nodes>;
using ElementMatrix = CellMatrix<8>;

/// Both throw InternalError where the cell is inverted at a Gauss point (check_quality comes
/// first).
Element make_hexahedron(const std::array<Eigen::Vector3d, 8>& nodes);
Tetrahedron make_tetrahedron(const std::array<Eigen::Vector3d, 10>& nodes);

/// Calls f with the element of a cell of a mesh, of the type of its shape.
template <typename Function>
void with_element(const Mesh& mesh, int cell, const Function& f) {
  const std::span<const int> numbers = mesh.cells[static_cast<std::size_t>(cell)];
  if (mesh.cells.shape() == CellShape::hexahedron) {
    std::array<Eigen::Vector3d, 8> nodes;
    for (std::size_t a = 0; a < 8; ++a) nodes[a] = mesh.nodes[numbers[a]];
    f(make_hexahedron(nodes));
  } else {
    std::array<Eigen::Vector3d, 10> nodes;
    for (std::size_t a = 0; a < 10; ++a) nodes[a] = mesh.nodes[numbers[a]];
    f(make_tetrahedron(nodes));
  }
}

/// m3, or InternalError as above.
double volume_of(const Mesh& mesh, int cell);

/// K_e = ∫ ε(v):C:ε(u); with mean_dilatation the volumetric strain is its mean over the cell (B-bar
/// of hexahedra). Exactly symmetric. Pressures of single cells may oscillate as ν → 1/2: the
/// constant of Babuška and Brezzi falls with the size of cells, of both kinds.
template <int Nodes, int Points>
CellMatrix<Nodes> element_stiffness(const CellElement<Nodes, Points>& element,
                                    const ElasticMaterial& material, bool mean_dilatation);

}  // namespace faultsim
