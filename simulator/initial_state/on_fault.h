#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "simulator/scene/field_depths.h"
#include "simulator/scene/scene.h"

/// The initial state at a place of a fault, as far as the scene alone says it: no mesh, no
/// operator.
namespace faultsim {

/// Effective traction and fluid pressure of a fault before any production.
struct InitialOnFault {
  double normal = 0;    ///< t'_N, Pa, tension > 0.
  double shear = 0;     ///< |t'_T| ≥ 0, Pa.
  double pressure = 0;  ///< p0 of the fluid in the fault, absolute, Pa.
};

/// The normal of a fault's plane, from the side of smaller x to that of larger x where it does not
/// strike along x.
std::array<double, 3> fault_normal(const Scene& scene, std::size_t fault);

/// t'_0 = σ0 n + α_f p0 n of the fault's plane at a depth (m), as cases start with it: p0 is that
/// of the column, and what blocks beside have of their own by the fault's rule (docs/model.md, 6).
InitialOnFault initial_on_fault(const Scene& scene, std::size_t fault, double depth,
                                DepthSide side = DepthSide::mean);

/// The largest t'_N > 0 on a fault before any production, Pa: what its opening lets go of. 0 where
/// all of it is pressed together, to 1 Pa. Of a fault of a mesh that of its mean plane.
double initial_opening(const Scene& scene, std::size_t fault);

/// The pressure regions (index in Scene::pressure) beside a fault of a field, west first; of a box,
/// where the mesh decides, all.
std::vector<std::size_t> regions_beside(const Scene& scene, std::size_t fault);

}  // namespace faultsim
