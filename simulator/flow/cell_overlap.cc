#include "simulator/flow/cell_overlap.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

using Tetrahedron = std::array<Eigen::Vector3d, 4>;

double tetrahedron_volume(const Tetrahedron& t) {
  return std::abs((t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0])) / 6;
}

std::array<Tetrahedron, 6> tetrahedra(const CellCorners& c) {
  return {{{c[0], c[1], c[2], c[6]},
           {c[0], c[2], c[3], c[6]},
           {c[0], c[3], c[7], c[6]},
           {c[0], c[7], c[4], c[6]},
           {c[0], c[4], c[5], c[6]},
           {c[0], c[5], c[1], c[6]}}};
}

/// The planes of a box: 2 axis + (0: what is above low, 1: what is below high) is kept.
constexpr int kPlanes = 6;

/// How far inside of a plane a point lies, m.
double inside_of(const FlowCell& box, int plane, const Eigen::Vector3d& point) {
  const int axis = plane / 2;
  return plane % 2 == 0 ? point[axis] - box.low[axis] : box.high[axis] - point[axis];
}

/// Volume of a tetrahedron within the planes from `plane` on: cut at the first one into the
/// tetrahedra that are left of it.
double clipped_volume(Tetrahedron t, const FlowCell& box, int plane) {
  for (; plane < kPlanes; ++plane) {
    const auto inside = [&](const Eigen::Vector3d& p) { return inside_of(box, plane, p); };
    const auto kept =
        std::partition(t.begin(), t.end(), [&](const auto& p) { return inside(p) > 0; }) -
        t.begin();
    if (kept == 0) return 0;
    if (kept == 4) continue;
    const auto cut = [&](int in, int out) -> Eigen::Vector3d {
      const double a = inside(t[in]), b = inside(t[out]);
      return t[in] + a / (a - b) * (t[out] - t[in]);
    };
    if (kept == 1) {
      t = {t[0], cut(0, 1), cut(0, 2), cut(0, 3)};
      continue;
    }
    if (kept == 3) {  // the prism below the corner that is cut off
      const Eigen::Vector3d a = cut(0, 3), b = cut(1, 3), c = cut(2, 3);
      return clipped_volume({t[0], t[1], t[2], a}, box, plane + 1) +
             clipped_volume({t[1], t[2], a, b}, box, plane + 1) +
             clipped_volume({t[2], a, b, c}, box, plane + 1);
    }
    // A wedge between the edge that is kept and the quadrangle of the cut.
    const Eigen::Vector3d a2 = cut(0, 2), a3 = cut(0, 3), b2 = cut(1, 2), b3 = cut(1, 3);
    return clipped_volume({t[0], t[1], a2, a3}, box, plane + 1) +
           clipped_volume({t[1], a2, a3, b2}, box, plane + 1) +
           clipped_volume({t[1], a3, b2, b3}, box, plane + 1);
  }
  return tetrahedron_volume(t);
}

}  // namespace

double cell_volume(const CellCorners& corners) {
  double volume = 0;
  for (const Tetrahedron& t : tetrahedra(corners)) volume += tetrahedron_volume(t);
  return volume;
}

double overlap_volume(const CellCorners& corners, const FlowCell& box) {
  for (int plane = 0; plane < kPlanes; ++plane) {
    const auto outside = [&](const auto& p) { return inside_of(box, plane, p) <= 0; };
    if (std::all_of(corners.begin(), corners.end(), outside)) return 0;
  }
  double volume = 0;
  for (const Tetrahedron& t : tetrahedra(corners)) volume += clipped_volume(t, box, 0);
  return volume;
}

}  // namespace faultsim
