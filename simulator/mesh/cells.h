#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

namespace faultsim {

/// Order of nodes as in VTK: of a hexahedron its eight corners; of a tetrahedron its four corners
/// 0–3, (1−0) × (2−0) · (3−0) > 0, then the middles of 01, 12, 20, 03, 13, 23.
enum class CellShape { hexahedron, tetrahedron };

constexpr std::size_t nodes_of_cell(CellShape shape) {
  return shape == CellShape::hexahedron ? 8 : 10;
}
/// Corners come first.
constexpr std::size_t corners_of_cell(CellShape shape) {
  return shape == CellShape::hexahedron ? 8 : 4;
}

/// Ends of the sides of a tetrahedron, in the order of the nodes in their middles.
inline constexpr std::array<std::array<std::size_t, 2>, 6> kTetrahedronSides = {
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
/// Corners of its faces, counter-clockwise seen from outside, and then the nodes in the middles of
/// 01, 12, 20 of these.
inline constexpr std::array<std::array<std::size_t, 6>, 4> kTetrahedronFaces = {
    {{1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}}};

/// The nodes of cells that are all of one shape.
class Cells {
 public:
  explicit Cells(CellShape shape = CellShape::hexahedron) : shape_(shape) {}

  CellShape shape() const { return shape_; }
  std::size_t n_nodes() const { return nodes_of_cell(shape_); }  ///< of a cell.
  std::size_t n_corners() const { return corners_of_cell(shape_); }
  std::size_t size() const { return nodes_.size() / n_nodes(); }
  bool empty() const { return nodes_.empty(); }
  std::span<const int> operator[](std::size_t cell) const {
    return {nodes_.data() + cell * n_nodes(), n_nodes()};
  }
  std::span<int> operator[](std::size_t cell) {
    return {nodes_.data() + cell * n_nodes(), n_nodes()};
  }
  std::span<const int> corners(std::size_t cell) const { return (*this)[cell].first(n_corners()); }
  void reserve(std::size_t n_cells) { nodes_.reserve(n_cells * n_nodes()); }
  /// @pre as many as a cell has.
  void add(std::span<const int> nodes) { nodes_.insert(nodes_.end(), nodes.begin(), nodes.end()); }
  void add(std::initializer_list<int> nodes) { nodes_.insert(nodes_.end(), nodes); }
  /// Of all cells, one after the other.
  const std::vector<int>& nodes() const { return nodes_; }
  bool operator==(const Cells&) const = default;

 private:
  CellShape shape_;
  std::vector<int> nodes_;
};

}  // namespace faultsim
