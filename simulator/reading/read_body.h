#pragma once

#include <string>
#include <vector>

#include "simulator/reading/scene_reader.h"

/// Inside of read_geometry: bodies that are no field, one file for each kind.
namespace faultsim {

void read_mesh_body(SceneReader& reader, Scene& scene);
/// @pre materials are read.
void read_horizons(SceneReader& reader, Scene& scene);

/// /geometry/boundary, of the sides of a box or the surfaces of its mesh.
void read_boundary(SceneReader& reader, BoxGeometry& box);
std::vector<std::string> material_names(const Scene& scene);

}  // namespace faultsim
