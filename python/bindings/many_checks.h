#pragma once

#include <vector>

#include "python/bindings/many_runs.h"
#include "simulator/simulation/loaded_scene.h"

namespace faultsim::python {

/// The outputs of a request to a scene. Throws InputError with all that is wrong before any case is
/// run: parameters, outputs and histories that are none, parameters given twice and, unless the
/// request keeps going, numbers that are not finite.
std::vector<OutputColumn> checked_columns(const LoadedScene& loaded, const ManyRequest& request);

}  // namespace faultsim::python
