#pragma once

#include "simulator/plan/cost.h"
#include "simulator/plan/plan.h"

namespace faultsim {

/// What an influence block of n_cells cells costs on top of the plan's operator.
InfluenceCost plan_influence(const Scene& scene, const Plan& plan, long n_cells);

}  // namespace faultsim
