#pragma once

#include <string>
#include <vector>

#include "campaign/answers/fault_sheet.h"

namespace faultsweep {

/// `faultsweep sheet`: sheets of faults as one HTML page that needs nothing else, each made for one
/// page of A4. Its tables and charts are those of to_answer(); beside them stands where the fault
/// is, as a picture.
/// @pre sheets are of one campaign, and not empty.
std::string sheet_page(const std::vector<FaultSheet>& sheets);

}  // namespace faultsweep
