#pragma once

#include <functional>
#include <string>

#include "simulator/elasticity/elasticity.h"

namespace faultsim {

/// Throws InputError about "/geometry/boundary" when a body (pieces that faults hold together) can
/// move as one, naming it and how it moves, or when no displacement is left to compute. Needs no
/// matrix: what a mesh and its conditions say by themselves.
void require_held(const Mesh& mesh, const DofMap& dofs);

/// "the block x 0 to 10 m, y 0 to 10 m, z -5 to 0 m (12 cells)".
/// @param member  whether a mesh node belongs to it.
std::string extent_text(const Mesh& mesh, const std::function<bool(int)>& member);

/// The InputError of require_held.
[[noreturn]] void throw_loose(const std::string& what);

}  // namespace faultsim
