#pragma once

#include <string>
#include <vector>

#include "simulator/measures/metrics.h"
#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// What the user of a result should know before believing it, one sentence each: the scene's
/// remarks, weight left out of the initial state, pressures above the initial one, nodes held
/// closed, observation points moved to a node, faults shorter than the activation length, a start
/// beyond Coulomb, weakening finer than the cells, faults open with fault_biot < 1.
/// @param result  complete but for its warnings.
std::vector<std::string> case_warnings(const Scene& scene, const FaultOperator& op,
                                       const FaultMeter& meter, const CaseResult& result);
/// That the result is of an interpolated operator, and how good that is.
std::string surface_warning(const CaseSurface& surface);

}  // namespace faultsim
