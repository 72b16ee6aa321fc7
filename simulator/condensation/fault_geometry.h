#pragma once

#include <vector>

#include "simulator/elasticity/elasticity.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// What each corner of a fault face has of its area, in whatever is averaged over the faces around
/// a node: m2, in plane strain m.
inline double corner_area(const FaultFace& face) {
  return face.area / static_cast<double>(face.n_corners());
}

/// The faults of a mesh as the contact solve sees them: surfaces, frames, areas, jump unknowns, and
/// per node the means over the fault faces around it, each weighted by the corner that is the
/// node's.
FaultGeometry fault_geometry(const Mesh& mesh, const std::vector<ElasticMaterial>& materials,
                             const DofMap& dofs, bool half_domain);

}  // namespace faultsim
