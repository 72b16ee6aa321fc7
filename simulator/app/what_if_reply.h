#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "simulator/case_figures/case_figures.h"
#include "simulator/common/errors.h"
#include "simulator/what_if/resident_case.h"

namespace faultsim {

/// Problems as the protocol has them (schemas/what_if_protocol.md).
nlohmann::json what_if_problems(const InputError& error);

/// What the reply to a finished question says of its case: outcome, sentences, charts, steps,
/// scene. A chart that cannot be drawn says why.
/// @param original  the case before the question's changes: drawn beside, and compared with in
///                  words; nullptr = none.
nlohmann::json what_if_reply(const ShownCase& shown, const ShownCase* original,
                             const std::vector<CaseChartRequest>& charts);

}  // namespace faultsim
