#pragma once

#include <string>
#include <vector>

#include "simulator/scene/scene.h"

namespace faultsim {

/// What to know of pressures that rise, a sentence each: above the initial one, where a storage
/// permit usually ends, and above the least total principal stress, where rock fractures, which is
/// not modelled. Of every region, and of every fault whose pressure is prescribed or a table's, at
/// the ends of the load steps. The stress is the initial one: a rise of pressure raises it too, so
/// that the second warning comes rather early than late.
std::vector<std::string> pressure_warnings(const Scene& scene);

}  // namespace faultsim
