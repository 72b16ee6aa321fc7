#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulator/mesh/cells.h"

namespace faultsim {

/// A face of one cell or of two.
struct CellFace {
  std::array<int, 4> sorted;            ///< corners, descending; −1 behind those of a triangle.
  std::array<int, 2> cells = {-1, -1};  ///< ascending; −1: none.
  std::array<std::size_t, 2> place = {0, 0};  ///< which face of each it is.
};

/// Corners of faces of cells: of a tetrahedron as in kTetrahedronFaces, of a hexahedron in the
/// order of Side. Counter-clockwise seen from outside, −1 behind those of a triangle.
std::array<int, 4> corners_of_face(CellShape shape, std::span<const int> corners, std::size_t face);

constexpr std::size_t faces_of_cell(CellShape shape) {
  return shape == CellShape::hexahedron ? 6 : 4;
}

/// Descending, as CellFace::sorted.
std::array<int, 4> sorted_corners(std::array<int, 4> corners);

/// The faces of all cells, each once, by their corners. Faces of more than two cells are returned
/// apart: no body has them. Time O(n log n).
struct CellFaces {
  std::vector<CellFace> faces;
  std::vector<std::array<int, 4>> overlapping;

  /// Place of the face that has these corners in `faces`, or −1.
  int find(const std::array<int, 4>& corners) const;
};

/// @param corners  corners_of_cell(shape) per cell.
CellFaces match_faces(CellShape shape, std::span<const int> corners);

}  // namespace faultsim
