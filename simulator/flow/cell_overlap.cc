#include "simulator/flow/cell_overlap.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace faultsim {
namespace {

using Tetrahedron = std::array<Eigen::Vector3d, 4>;

double signed_volume(const Tetrahedron& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0]) / 6;
}

double tetrahedron_volume(const Tetrahedron& t) { return std::abs(signed_volume(t)); }

std::array<Tetrahedron, 6> tetrahedra(const CellCorners& c) {
  return {{{c[0], c[1], c[2], c[6]},
           {c[0], c[2], c[3], c[6]},
           {c[0], c[3], c[7], c[6]},
           {c[0], c[7], c[4], c[6]},
           {c[0], c[4], c[5], c[6]},
           {c[0], c[5], c[1], c[6]}}};
}

/// The planes of a box: 2 axis + (0: what is above low, 1: what is below high) is kept.
struct BoxPlanes {
  static constexpr int kPlanes = 6;
  const Eigen::Vector3d& low;
  const Eigen::Vector3d& high;

  /// How far inside of a plane a point lies, m.
  double inside(int plane, const Eigen::Vector3d& point) const {
    const int axis = plane / 2;
    return plane % 2 == 0 ? point[axis] - low[axis] : high[axis] - point[axis];
  }
};

/// The planes of a tetrahedron that is not flat, each opposite to its corner.
struct TetrahedronPlanes {
  static constexpr int kPlanes = 4;
  std::array<Eigen::Vector3d, 4> normal;
  std::array<Eigen::Vector3d, 4> foot;

  explicit TetrahedronPlanes(const Tetrahedron& t) {
    for (int i = 0; i < 4; ++i) {
      foot[i] = t[(i + 1) % 4];
      normal[i] = (t[(i + 2) % 4] - foot[i]).cross(t[(i + 3) % 4] - foot[i]);
      if (normal[i].dot(t[i] - foot[i]) < 0) normal[i] = -normal[i];
    }
  }
  /// Of the sign of the distance inside, and proportional to it.
  double inside(int plane, const Eigen::Vector3d& point) const {
    return normal[plane].dot(point - foot[plane]);
  }
};

/// Whether one plane has all points on its outer side.
template <typename Planes, typename Points>
bool is_apart(const Planes& planes, const Points& points) {
  for (int plane = 0; plane < Planes::kPlanes; ++plane) {
    const auto outside = [&](const auto& p) { return planes.inside(plane, p) <= 0; };
    if (std::ranges::all_of(points, outside)) return true;
  }
  return false;
}

/// Volume of a tetrahedron within the planes from `plane` on: cut at the first one into the
/// tetrahedra that are left of it.
template <typename Planes>
double clipped_volume(Tetrahedron t, const Planes& planes, int plane) {
  for (; plane < Planes::kPlanes; ++plane) {
    const auto inside = [&](const Eigen::Vector3d& p) { return planes.inside(plane, p); };
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
      return clipped_volume({t[0], t[1], t[2], a}, planes, plane + 1) +
             clipped_volume({t[1], t[2], a, b}, planes, plane + 1) +
             clipped_volume({t[2], a, b, c}, planes, plane + 1);
    }
    // A wedge between the edge that is kept and the quadrangle of the cut.
    const Eigen::Vector3d a2 = cut(0, 2), a3 = cut(0, 3), b2 = cut(1, 2), b3 = cut(1, 3);
    return clipped_volume({t[0], t[1], a2, a3}, planes, plane + 1) +
           clipped_volume({t[1], a2, a3, b2}, planes, plane + 1) +
           clipped_volume({t[1], a3, b2, b3}, planes, plane + 1);
  }
  return tetrahedron_volume(t);
}

/// A tetrahedron of a flow cell.
struct Part {
  Tetrahedron corners;
  double sign;  ///< -1 where a twisted cell turns it inside out.
};

constexpr double kFlat = 1e-12;  ///< of a cell's volume: what is less has no planes of its own.

/// The tetrahedra of a hexahedron of either handedness, without the flat ones of pinched edges.
std::vector<Part> parts_of(const CellCorners& corners) {
  const std::array<Tetrahedron, 6> all = tetrahedra(corners);
  double total = 0;
  for (const Tetrahedron& t : all) total += signed_volume(t);
  std::vector<Part> parts;
  for (const Tetrahedron& t : all) {
    const double volume = signed_volume(t);
    if (std::abs(volume) > kFlat * std::abs(total))
      parts.push_back({.corners = t, .sign = (volume > 0) == (total > 0) ? 1.0 : -1.0});
  }
  return parts;
}

CellCorners moved(CellCorners corners, const Eigen::Vector3d& origin) {
  for (Eigen::Vector3d& corner : corners) corner -= origin;
  return corners;
}

double overlap_of_hexahedra(const CellCorners& corners, const CellCorners& flow_corners) {
  // Near the origin, so that coordinates of maps cost no digits.
  const CellCorners cell = moved(corners, corners[0]);
  const std::vector<Part> parts = parts_of(moved(flow_corners, corners[0]));
  const FlowCell around = flow_cell_around(cell);
  double volume = 0;
  if (!around.corners) {
    const BoxPlanes box{.low = around.low, .high = around.high};
    for (const Part& part : parts) {
      if (!is_apart(box, part.corners)) volume += part.sign * clipped_volume(part.corners, box, 0);
    }
  } else {
    const std::array<Tetrahedron, 6> own = tetrahedra(cell);
    for (const Part& part : parts) {
      const TetrahedronPlanes planes(part.corners);
      for (const Tetrahedron& t : own) {
        if (!is_apart(planes, t) && !is_apart(TetrahedronPlanes(t), part.corners))
          volume += part.sign * clipped_volume(t, planes, 0);
      }
    }
  }
  return volume > kFlat * cell_volume(cell) ? volume : 0;
}

}  // namespace

double cell_volume(const CellCorners& corners) {
  double volume = 0;
  for (const Tetrahedron& t : tetrahedra(corners)) volume += tetrahedron_volume(t);
  return volume;
}

double flow_cell_volume(const FlowCell& cell) {
  if (!cell.corners) return (cell.high - cell.low).prod();
  double volume = 0;
  for (const Tetrahedron& t : tetrahedra(*cell.corners)) volume += signed_volume(t);
  return std::abs(volume);
}

double overlap_volume(const CellCorners& corners, const FlowCell& flow_cell) {
  const BoxPlanes box{.low = flow_cell.low, .high = flow_cell.high};
  if (is_apart(box, corners)) return 0;
  if (flow_cell.corners) return overlap_of_hexahedra(corners, *flow_cell.corners);
  double volume = 0;
  for (const Tetrahedron& t : tetrahedra(corners)) volume += clipped_volume(t, box, 0);
  return volume;
}

}  // namespace faultsim
