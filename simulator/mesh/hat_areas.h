#pragma once

#include <Eigen/Core>
#include <array>

namespace faultsim {

/// Areas of the linear hats of a facet, ∫ N_k dA, m2.
struct HatAreas {
  double total = 0;
  std::array<double, 4> corner = {0, 0, 0, 0};
};

/// Of a flat quadrilateral, exact with 2x2 Gauss points as |∂x/∂s × ∂x/∂t| is linear.
HatAreas quad_areas(const std::array<Eigen::Vector3d, 4>& p);
HatAreas triangle_areas(const std::array<Eigen::Vector3d, 3>& p);

}  // namespace faultsim
