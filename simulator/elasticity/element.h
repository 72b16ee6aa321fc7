#pragma once

#include <Eigen/Core>
#include <array>

#include "simulator/elasticity/elasticity.h"

namespace faultsim {

using ElementMatrix = Eigen::Matrix<double, 24, 24>;  ///< rows 3 a + component, a = corner.

/// Shape function gradients of a trilinear hexahedron at its 2x2x2 Gauss points.
struct Element {
  std::array<Eigen::Matrix<double, 8, 3>, 8> gradient;  ///< per Gauss point, dN_a/dx_i, 1/m.
  std::array<double, 8> weight;                         ///< det J at the point, m3.
  Eigen::Matrix<double, 8, 3> mean_gradient;            ///< volume averages of the gradients.
  double volume = 0;                                    ///< m3.
};

/// Throws InternalError when the cell is inverted at a Gauss point (check_quality comes first).
Element make_element(const Mesh& mesh, int cell);

/// K_e = ∫ ε(v):C:ε(u); with b_bar the volumetric strain is its mean over the cell. Exactly
/// symmetric.
ElementMatrix element_stiffness(const Element& element, const ElasticMaterial& material,
                                bool b_bar);

}  // namespace faultsim
