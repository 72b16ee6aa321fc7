#pragma once

#include <string>
#include <vector>

#include "simulator/corner_point/grid_structure.h"

namespace faultsim::corner_point {

/// Remarks as plain text: a sentence a line, with what changes it in brackets.
std::string remarks_text(const std::vector<StructureRemark>& remarks);

/// The report as plain text: a sentence a line, then a table of faults and one of compartments.
std::string structure_text(const GridStructure& structure);

/// Traces as CSV: a line for each point: fault (from 1), x [m], y [m].
std::string traces_csv(const GridStructure& structure);

/// Offsets as CSV: a line for each pillar: fault, along [m], x [m], y [m], offset [m] (> 0: right
/// is lower).
std::string offsets_csv(const GridStructure& structure);

}  // namespace faultsim::corner_point
