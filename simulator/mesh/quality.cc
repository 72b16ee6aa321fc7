#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"
#include "simulator/mesh/structured_grid.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

constexpr double kLeastJacobian = 0.1;  // below this the element's stiffness is badly conditioned

/// The three nodes joined to each corner of a VTK hexahedron, right-handed.
constexpr std::array<std::array<size_t, 3>, 8> kNeighbours = {
    {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};

struct CellQuality {
  double scaled_jacobian;
  double aspect;
};

CellQuality cell_quality(const std::array<Vector3d, 8>& p) {
  double least = 1, shortest = std::numeric_limits<double>::infinity(), longest = 0;
  for (size_t v = 0; v < 8; ++v) {
    const Vector3d a = p[kNeighbours[v][0]] - p[v], b = p[kNeighbours[v][1]] - p[v],
                   c = p[kNeighbours[v][2]] - p[v];
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    shortest = std::min({shortest, la, lb, lc});
    longest = std::max({longest, la, lb, lc});
    const double product = la * lb * lc;
    least = std::min(least, product > 0 ? a.cross(b).dot(c) / product : -1.0);
  }
  return {least, shortest > 0 ? longest / shortest : std::numeric_limits<double>::infinity()};
}

}  // namespace

MeshQuality check_quality(const Mesh& mesh) {
  MeshQuality quality;
  for (const std::array<int, 8>& cell : mesh.cells) {
    std::array<Vector3d, 8> p;
    Vector3d centre = Vector3d::Zero();
    for (size_t v = 0; v < 8; ++v) {
      p[v] = mesh.nodes[static_cast<size_t>(cell[v])];
      centre += 0.125 * p[v];
    }
    const CellQuality one = cell_quality(p);
    quality.max_aspect = std::max(quality.max_aspect, one.aspect);
    // Negated, so that a NaN position is the worst of all.
    if (!(one.scaled_jacobian >= quality.min_scaled_jacobian)) {
      quality.min_scaled_jacobian = one.scaled_jacobian;
      quality.worst_position = centre;
      if (std::isnan(one.scaled_jacobian)) break;
    }
  }
  if (!(quality.min_scaled_jacobian > kLeastJacobian)) {
    const Vector3d& at = quality.worst_position;
    quality.refusal = concat("a cell at x = ", at.x(), " m, y = ", at.y(), " m, z = ", at.z(),
                             " m is too distorted: its scaled Jacobian ",
                             quality.min_scaled_jacobian, " is not above ", kLeastJacobian,
                             "; move the faults apart, reduce their dip or enlarge the body");
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
