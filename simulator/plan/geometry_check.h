#pragma once

#include <memory>
#include <vector>

#include "simulator/plan/plan.h"

namespace faultsim {

/// Meshes larger than this are not made only to be looked at: a fraction of a second.
inline constexpr long kMostCellsChecked = 100'000;

/// What a run would refuse once it has the mesh: a fault that splits no node, tied faces that do
/// not match, cells that are too distorted, a body that nothing holds; with a surface of operators,
/// ranges over which it cannot be built (surface_problems). Makes the mesh, no matrix; silent about
/// more than kMostCellsChecked cells. @pre the scene and plan had no problems.
/// @param made  is given the mesh, where it was made and is sound.
std::vector<Problem> geometry_problems(const Scene& scene, const Plan& plan,
                                       std::shared_ptr<const Mesh>* made = nullptr);

/// Where the operators of a surface cannot be built: a scene at an end of a range that cannot be
/// planned or meshed, whose mesh has other cells, or another node for an observation point. Looked
/// at are the ends of the ranges of dips and offsets, one at a time, then their corners (up to 16);
/// meshes are made while they are few cells. Between them the builder looks.
/// @pre the scene itself can be planned; scene.numerics.surface.wanted().
std::vector<Problem> surface_problems(const Scene& scene, const Plan& plan);

}  // namespace faultsim
