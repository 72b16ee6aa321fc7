#pragma once

#include <set>
#include <string>

#include "simulator/result/result.h"

namespace faultsweep {

/// Where two results of one case differ, compared bit for bit in all that the store keeps of a
/// result: "load step 7 (gas_storage)", "the outcome"; "" when they are the same.
/// @param stored  as read from the store: without title, regions and observations.
std::string first_difference(const faultsim::CaseResult& stored, const faultsim::CaseResult& again);

/// A result without what is not compared, as it differs from run to run or is not stored: title,
/// operator, warnings, solver counts, wall times and observations.
faultsim::CaseResult bare(faultsim::CaseResult result);

/// Keys of measures and fields of a case that were added after results had been stored, which then
/// have none: that is not a difference.
const std::set<std::string>& later_fields();

}  // namespace faultsweep
