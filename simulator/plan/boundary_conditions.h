#pragma once

#include <vector>

#include "simulator/elasticity/elasticity.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Whether a condition of a box is a unit load: a prescribed displacement or stress.
bool is_load(BoundaryKind kind);

/// The displacements that a scene prescribes on the sides of its body, in document order. A field
/// stands on rollers, its top is free; ties are in the mesh.
/// @param first_load  number of the first load of the boundary; the others follow in document
/// order.
std::vector<DisplacementCondition> displacement_conditions(const Scene& scene, int first_load);

}  // namespace faultsim
