#pragma once

#include <string_view>

#include "simulator/gmsh/gmsh_content.h"
#include "simulator/gmsh/sections.h"

namespace faultsim {

/// Reads the sections of a file of this form into numbers; goes on behind what is wrong.
GmshContent read_content(std::string_view text, const FileForm& form, FileProblems& problems);

}  // namespace faultsim
