#pragma once

#include <string>
#include <vector>

#include "simulator/plan/creep_estimate.h"
#include "simulator/plan/plan.h"

/// Whether viscous materials creep, and with which steps.
namespace faultsim {

/// The reduction "creep_off": viscous materials are taken as elastic. Applied when switched off, or
/// when `automatic` and the bound is below a tenth of creep_tolerance.
Reduction plan_creep_off(const Scene& scene, const CreepEstimate& estimate);

/// Lengths of the load steps, s, descending; two that agree to 1e-9 are one.
std::vector<double> load_step_lengths(const Scene& scene);

/// The step lengths that creep needs, see CreepPlan::rungs.
std::vector<double> creep_rungs(const Scene& scene);

/// "creep: steps of 1 year, 182.6 days; 3 operators with the elastic one\n"; "" when not active.
std::string creep_text(const CreepPlan& creep);

}  // namespace faultsim
