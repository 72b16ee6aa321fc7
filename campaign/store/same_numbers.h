#pragma once

#include <string>

#include "simulator/result/result.h"

namespace faultsweep {

/// Where two results of one case differ, compared bit for bit in all that the store keeps of a
/// result: "load step 7 (gas_storage)", "the outcome"; "" when they are the same.
/// @param stored  as read from the store: without title, regions and observations.
std::string first_difference(const faultsim::CaseResult& stored, const faultsim::CaseResult& again);

}  // namespace faultsweep
