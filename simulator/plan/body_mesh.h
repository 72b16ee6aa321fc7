#pragma once

#include "simulator/mesh/uncut_mesh.h"
#include "simulator/plan/cost.h"
#include "simulator/scene/scene.h"

/// Scenes whose body is a mesh: from a file, or built of horizons.
namespace faultsim {

/// The body before its faults cut it: materials and compartments by the scene's numbers, faults in
/// its order. Boundary groups are the surfaces of the mesh, by their numbers there; those
/// that no boundary condition names have no facets.
/// @pre is_meshed(scene).
UncutMesh uncut_mesh(const Scene& scene);

/// Of a material of the scene, its place among them.
int material_index(const Scene& scene, const std::string& name);

/// Cut, and its cells looked at. Throws InputError about the file, or the scene whose
/// horizons it is built of.
Mesh body_mesh(const Scene& scene);

/// A cube of as many nodes, with planes of as many jumps: unknowns of tetrahedra cost what those of
/// grids do.
GridShape shape_of_mesh(const Scene& scene);

}  // namespace faultsim
