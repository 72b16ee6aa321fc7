#pragma once

#include <optional>
#include <string>

#include "simulator/scene/geometry.h"

/// What a mesh is in terms of a box: bounds, and planes in place of surfaces.
namespace faultsim {

/// Fills `from`, `to`, `regions` and BodyMesh::n_sides from the mesh and its volumes: compartments
/// in the order of their first volume.
/// @pre box.mesh.
void describe_mesh(BoxGeometry& box);

/// Number of a surface, into facet_groups; −1 = none of that name.
int surface_number(const NamedMesh& mesh, const std::string& name);

/// The mean plane of a surface: its facets' centre and normal by area, and its extent
/// along strike and down dip.
PatchGeometry mean_patch(const NamedMesh& mesh, int surface);

/// The axis across a surface that lies in a plane across one (0 = x); nothing of others.
std::optional<std::size_t> axis_across(const NamedMesh& mesh, int surface);

}  // namespace faultsim
