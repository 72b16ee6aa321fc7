#pragma once

#include "simulator/gmsh/gmsh_content.h"
#include "simulator/gmsh/records.h"

namespace faultsim {

/// Reads $Nodes into node_tags, points, node_places. Whether all of it could be read.
bool read_nodes(Records& records, FileProblems& problems, GmshContent& content);

}  // namespace faultsim
