#pragma once

#include "simulator/plan/plan.h"

namespace faultsim {

/// The step lengths that creep needs, see CreepPlan::rungs.
std::vector<double> creep_rungs(const Scene& scene);

}  // namespace faultsim
