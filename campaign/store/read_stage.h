#pragma once

#include "campaign/store/sqlite.h"
#include "simulator/output/result.h"

namespace faultsweep {

/// Reads activated, activation_step, activated fault's name, opening_step, chi_bar, chi_max, area,
/// thickness, activated, slipping and open area, max_slip, potency, moment, magnitude, n_events,
/// event_moment, event_magnitude, first and last step, opened fault's name, activation_resolved
/// (NULL: not known, as not resolved) from 22 columns that start at `first`. Without its faults.
faultsim::StageMetrics read_stage_metrics(const Statement& row, int first);

}  // namespace faultsweep
