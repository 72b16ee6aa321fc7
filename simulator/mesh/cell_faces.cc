#include "simulator/mesh/cell_faces.h"

#include <algorithm>
#include <functional>

namespace faultsim {
namespace {

constexpr std::array<std::array<std::size_t, 4>, 6> kHexahedronFaces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

/// A face as one cell has it.
struct OneSide {
  std::array<int, 4> sorted;
  int cell;
  std::size_t place;
};

std::vector<OneSide> all_sides(CellShape shape, std::span<const int> corners) {
  const std::size_t n = corners_of_cell(shape), n_faces = faces_of_cell(shape);
  std::vector<OneSide> sides;
  sides.reserve(corners.size() / n * n_faces);
  for (std::size_t cell = 0; cell < corners.size() / n; ++cell) {
    for (std::size_t face = 0; face < n_faces; ++face)
      sides.push_back({sorted_corners(corners_of_face(shape, corners.subspan(n * cell, n), face)),
                       static_cast<int>(cell), face});
  }
  std::ranges::sort(sides, [](const OneSide& a, const OneSide& b) {
    return a.sorted != b.sorted ? a.sorted < b.sorted : a.cell < b.cell;
  });
  return sides;
}

}  // namespace

std::array<int, 4> corners_of_face(CellShape shape, std::span<const int> corners,
                                   std::size_t face) {
  std::array<int, 4> found = {-1, -1, -1, -1};
  if (shape == CellShape::tetrahedron) {
    for (std::size_t v = 0; v < 3; ++v) found[v] = corners[kTetrahedronFaces[face][v]];
  } else {
    for (std::size_t v = 0; v < 4; ++v) found[v] = corners[kHexahedronFaces[face][v]];
  }
  return found;
}

std::array<int, 4> sorted_corners(std::array<int, 4> corners) {
  std::ranges::sort(corners, std::greater<>());
  return corners;
}

int CellFaces::find(const std::array<int, 4>& corners) const {
  const std::array<int, 4> wanted = sorted_corners(corners);
  const auto at = std::ranges::lower_bound(faces, wanted, {}, &CellFace::sorted);
  return at != faces.end() && at->sorted == wanted ? static_cast<int>(at - faces.begin()) : -1;
}

CellFaces match_faces(CellShape shape, std::span<const int> corners) {
  CellFaces found;
  for (const OneSide& side : all_sides(shape, corners)) {
    if (found.faces.empty() || found.faces.back().sorted != side.sorted) {
      found.faces.push_back({side.sorted, {side.cell, -1}, {side.place, 0}});
    } else if (found.faces.back().cells[1] < 0) {
      found.faces.back().cells[1] = side.cell;
      found.faces.back().place[1] = side.place;
    } else if (found.overlapping.empty() || found.overlapping.back() != side.sorted) {
      found.overlapping.push_back(side.sorted);
    }
  }
  return found;
}

}  // namespace faultsim
