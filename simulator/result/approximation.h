#pragma once

#include <string>

#include "simulator/result/result.h"

namespace faultsim {

/// What is approximate of a result beyond its mesh and time steps, as sentences for its readers: an
/// operator that was interpolated, with its measured relative errors, rounded up to two digits; a
/// flow result that does not cover the compartments, with the share that it covers, rounded down to
/// a tenth of a percent. "" where nothing is. The time error of creep is one of each load step
/// (StepCreep).
std::string approximation_sentence(const CaseResult& result);

}  // namespace faultsim
