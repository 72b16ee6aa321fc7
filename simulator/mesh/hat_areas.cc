#include "simulator/mesh/hat_areas.h"

#include <Eigen/Geometry>
#include <cmath>

namespace faultsim {

HatAreas quad_areas(const std::array<Eigen::Vector3d, 4>& p) {
  const double g = 1 / std::sqrt(3.0);
  constexpr std::array<double, 4> kS = {-1, 1, 1, -1}, kT = {-1, -1, 1, 1};
  HatAreas areas;
  for (std::size_t q = 0; q < 4; ++q) {
    const double s = g * kS[q], t = g * kT[q];
    Eigen::Vector3d ds = Eigen::Vector3d::Zero(), dt = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      ds += 0.25 * kS[k] * (1 + kT[k] * t) * p[k];
      dt += 0.25 * kT[k] * (1 + kS[k] * s) * p[k];
    }
    const double area = ds.cross(dt).norm();
    areas.total += area;
    for (std::size_t k = 0; k < 4; ++k)
      areas.corner[k] += area * 0.25 * (1 + kS[k] * s) * (1 + kT[k] * t);
  }
  return areas;
}

HatAreas triangle_areas(const std::array<Eigen::Vector3d, 3>& p) {
  const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
  return {area, {area / 3, area / 3, area / 3, 0}};
}

}  // namespace faultsim
