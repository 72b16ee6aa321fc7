#pragma once

#include <cstdint>
#include <vector>

#include "campaign/store/sqlite.h"
#include "simulator/output/result.h"

namespace faultsweep {

/// Reads names of both regions ("" = none), changes and absolute pressures, and the change in the
/// fault, from 7 columns.
faultsim::SidePressures read_side_pressures(const Statement& row, int first);
/// What a case's faults did in a stage, with their onsets, in the order of the scene. Empty for
/// results from before fault_metrics.
std::vector<faultsim::FaultStageMetrics> read_fault_rows(Connection& db, std::int64_t case_id,
                                                         std::int64_t stage_id);
/// One of them.
faultsim::FaultStageMetrics read_fault_row(Connection& db, std::int64_t case_id,
                                           std::int64_t stage_id, std::int64_t fault_id);

}  // namespace faultsweep
