#include "simulator/flow/cell_overlap.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

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

/// What is not behind a plane is kept: normal · p >= offset.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
  /// How far inside a point lies, m times the normal's length.
  double inside(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
};

std::array<Plane, 6> planes_of(const FlowCell& box) {
  std::array<Plane, 6> planes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    planes[static_cast<std::size_t>(2 * axis)] = {unit, box.low[axis]};
    planes[static_cast<std::size_t>(2 * axis + 1)] = {-unit, -box.high[axis]};
  }
  return planes;
}

/// The sides of a tetrahedron, each with the other corner inside.
std::array<Plane, 4> planes_of(const Tetrahedron& t) {
  std::array<Plane, 4> planes;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d &a = t[(i + 1) % 4], &b = t[(i + 2) % 4], &c = t[(i + 3) % 4];
    Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.dot(t[i] - a) < 0) normal = -normal;
    planes[i] = {normal, normal.dot(a)};
  }
  return planes;
}

/// Volume of a tetrahedron within the planes: cut at the first one into the tetrahedra that are left
/// of it.
double clipped_volume(Tetrahedron t, std::span<const Plane> planes) {
  for (; !planes.empty(); planes = planes.subspan(1)) {
    const auto inside = [&](const Eigen::Vector3d& p) { return planes.front().inside(p); };
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
      return clipped_volume({t[0], t[1], t[2], a}, planes.subspan(1)) +
             clipped_volume({t[1], t[2], a, b}, planes.subspan(1)) +
             clipped_volume({t[2], a, b, c}, planes.subspan(1));
    }
    // A wedge between the edge that is kept and the quadrangle of the cut.
    const Eigen::Vector3d a2 = cut(0, 2), a3 = cut(0, 3), b2 = cut(1, 2), b3 = cut(1, 3);
    return clipped_volume({t[0], t[1], a2, a3}, planes.subspan(1)) +
           clipped_volume({t[1], a2, a3, b2}, planes.subspan(1)) +
           clipped_volume({t[1], a3, b2, b3}, planes.subspan(1));
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
  const std::array<Plane, 6> planes = planes_of(box);
  for (const Plane& plane : planes) {
    const auto outside = [&](const auto& p) { return plane.inside(p) <= 0; };
    if (std::all_of(corners.begin(), corners.end(), outside)) return 0;
  }
  double volume = 0;
  for (const Tetrahedron& t : tetrahedra(corners)) volume += clipped_volume(t, planes);
  return volume;
}

double overlap_volume(const CellCorners& corners, const CellCorners& other) {
  const std::array<Tetrahedron, 6> mine = tetrahedra(corners);
  double volume = 0;
  for (const Tetrahedron& theirs : tetrahedra(other)) {
    if (tetrahedron_volume(theirs) == 0) continue;  // of a cell that is pinched out
    const std::array<Plane, 4> planes = planes_of(theirs);
    for (const Tetrahedron& t : mine) volume += clipped_volume(t, planes);
  }
  return volume;
}

}  // namespace faultsim
