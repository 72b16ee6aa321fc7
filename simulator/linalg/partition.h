#pragma once

#include <vector>

namespace faultsim {

/// A mesh as far as its division asks: which vertices share a cell.
struct VertexCells {
  int n_vertices = 0;
  std::vector<int> begin = {0};  ///< per cell, into vertices.
  std::vector<int> vertices;
  std::vector<int> weight;  ///< per vertex, ≥ 1.
};
/// Which part each vertex belongs to, 0 … n_parts − 1: parts of nearly the same weight, between
/// which few cells lie (METIS, k-way on the graph of vertices that share a cell). Same input, same
/// parts. Throws ResourceError when memory is short, Interrupted at a signal that METIS caught.
std::vector<int> partition(const VertexCells& cells, int n_parts);

}  // namespace faultsim
