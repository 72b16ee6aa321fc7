#pragma once

#include <optional>

#include "simulator/plan/plan.h"

namespace faultsim {

/// Refuses a plan that does not fit before hours are spent on it: ResourceError with what the
/// operator needs, what there is, and the cure.
/// @param available       bytes; none = not checked.
/// @param may_go_without  a run on the coupled path is another cure, where nothing creeps.
void require_memory(const Plan& plan, std::optional<double> available, bool may_go_without = true);

}  // namespace faultsim
