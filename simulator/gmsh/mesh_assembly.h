#pragma once

#include "simulator/gmsh/file_problems.h"
#include "simulator/gmsh/gmsh_content.h"
#include "simulator/gmsh/gmsh_mesh.h"

namespace faultsim {

/// Puts a mesh together from what stands in a file. Tells what does not fit; the mesh is none then.
GmshMesh assemble_mesh(const GmshContent& content, FileProblems& problems);

}  // namespace faultsim
