#pragma once

#include "campaign/answers/sensitivity.h"

/// Inside of the module: the numbers of a sensitivity.
namespace faultsweep {

/// Adds Sensitivity::metrics and what belongs to them.
/// @pre all else is there, the columns of the sample too; `over_steps` has its metrics.
void add_indices(const Store& store, Sensitivity& s);

}  // namespace faultsweep
