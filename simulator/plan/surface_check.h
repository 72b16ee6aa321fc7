#pragma once

#include <vector>

#include "simulator/plan/plan.h"

namespace faultsim {

/// Where the operators of a surface cannot be built: a scene at an end of a range that cannot be
/// planned or meshed, whose mesh has other cells, or another node for an observation point. Looked
/// at are the ends of the ranges of dips and offsets, one at a time, then their corners (up to 16);
/// meshes are made while they are few cells. Between them the builder looks.
/// @pre the scene itself can be planned; scene.numerics.surface.wanted().
std::vector<Problem> surface_problems(const Scene& scene, const Plan& plan);

}  // namespace faultsim
