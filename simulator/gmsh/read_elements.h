#pragma once

#include "simulator/gmsh/gmsh_content.h"
#include "simulator/gmsh/records.h"

namespace faultsim {

/// Reads $Elements into blocks. Whether all of it could be read.
bool read_elements(Records& records, FileProblems& problems, GmshContent& content);

}  // namespace faultsim
