#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "simulator/common/errors.h"
#include "simulator/mesh/structured_grid.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

/// Below this an element's stiffness is badly conditioned; cells of a generator are better than
/// those that fill a body between given surfaces.
double least_jacobian(CellShape shape) { return shape == CellShape::hexahedron ? 0.1 : 1e-3; }

/// The three nodes joined to each corner of a VTK hexahedron, right-handed.
constexpr std::array<std::array<size_t, 3>, 8> kNeighbours = {
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
/// Those of a tetrahedron.
constexpr std::array<std::array<size_t, 3>, 4> kOthers = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct CellQuality {
  double scaled_jacobian;
  double aspect;
};

/// @param corners     of the cell.
/// @param neighbours  of each corner, right-handed.
/// @param regular     scaled Jacobian of a cell of equal edges: 1 of a cube, 1/√2 of a tetrahedron.
template <size_t N>
CellQuality cell_quality(std::span<const Vector3d> corners,
                         const std::array<std::array<size_t, 3>, N>& neighbours, double regular) {
  double least = 1, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (size_t v = 0; v < N; ++v) {
    const Vector3d a = corners[neighbours[v][0]] - corners[v],
                   b = corners[neighbours[v][1]] - corners[v],
                   c = corners[neighbours[v][2]] - corners[v];
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    shortest = std::min({shortest, la, lb, lc});
    longest = std::max({longest, la, lb, lc});
    const double product = la * lb * lc;
    least = std::min(least, product > 0 ? a.cross(b).dot(c) / (regular * product) : -1.0);
  }
  return {least, shortest > 0 ? longest / shortest : std::numeric_limits<double>::infinity()};
}

}  // namespace

MeshQuality check_quality(const Mesh& mesh) {
  MeshQuality quality;
  const double regular = 1 / std::sqrt(2.0);
  std::vector<Vector3d> corners;
  for (size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    corners.clear();
    Vector3d centre = Vector3d::Zero();
    for (const int node : mesh.cells.corners(cell)) {
      corners.push_back(mesh.nodes[static_cast<size_t>(node)]);
      centre += corners.back() / static_cast<double>(mesh.cells.n_corners());
    }
    const CellQuality one = mesh.cells.shape() == CellShape::hexahedron
                                ? cell_quality(corners, kNeighbours, 1)
                                : cell_quality(corners, kOthers, regular);
    quality.max_aspect = std::max(quality.max_aspect, one.aspect);
    // Negated, so that a NaN position is the worst of all.
    if (!(one.scaled_jacobian >= quality.min_scaled_jacobian)) {
      quality.min_scaled_jacobian = one.scaled_jacobian;
      quality.worst_position = centre;
      if (std::isnan(one.scaled_jacobian)) break;
    }
  }
  const double least = least_jacobian(mesh.cells.shape());
  if (!(quality.min_scaled_jacobian > least)) {
    const Vector3d& at = quality.worst_position;
    quality.refusal = concat("a cell at x = ", at.x(), " m, y = ", at.y(), " m, z = ", at.z(),
                             " m is too distorted: its scaled Jacobian ",
                             quality.min_scaled_jacobian, " is not above ", least,
                             mesh.cells.shape() == CellShape::hexahedron
                                 ? "; move the faults apart, reduce their dip or enlarge the body"
                                 : "; refine the mesh there, or optimise it (Mesh.Optimize)");
  }
  return quality;
}

void refuse_bad_cells(const Mesh& mesh) {
  const std::string refusal = check_quality(mesh).refusal;
  if (refusal.empty()) return;
  const size_t cut = refusal.find("; ");
  throw InputError("scene", {{"/geometry", 0, refusal.substr(0, cut), refusal.substr(cut + 2)}});
}

}  // namespace faultsim
