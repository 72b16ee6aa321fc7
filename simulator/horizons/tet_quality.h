#pragma once

#include <Eigen/Core>
#include <array>

namespace faultsim::horizons {

/// The scaled inverse condition number of a tetrahedron: 3 / (|A| |A⁻¹|) with Frobenius norms, A
/// from the regular one to it, and the sign of its volume. 1 of a regular one, 0 of a flat one.
double scaled_inverse_condition(const std::array<Eigen::Vector3d, 4>& corners);

}  // namespace faultsim::horizons
