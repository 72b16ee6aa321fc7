#include "simulator/horizons/tet_quality.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

namespace faultsim::horizons {

double scaled_inverse_condition(const std::array<Eigen::Vector3d, 4>& corners) {
  Eigen::Matrix3d own, regular;
  for (std::size_t k = 0; k < 3; ++k)
    own.col(static_cast<Eigen::Index>(k)) = corners[k + 1] - corners[0];
  regular << 1, 0.5, 0.5,                         //
      0, std::sqrt(3.0) / 2, std::sqrt(3.0) / 6,  //
      0, 0, std::sqrt(2.0 / 3);
  const Eigen::Matrix3d map = own * regular.inverse();
  const double det = map.determinant();
  if (det == 0) return 0;
  // |A⁻¹| = |adj A| / |det A|: no division before the last.
  Eigen::Matrix3d adjugate;
  adjugate.col(0) = map.col(1).cross(map.col(2));
  adjugate.col(1) = map.col(2).cross(map.col(0));
  adjugate.col(2) = map.col(0).cross(map.col(1));
  return 3 * det / (map.norm() * adjugate.norm());
}

}  // namespace faultsim::horizons
