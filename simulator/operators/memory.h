#pragma once

#include <optional>

#include "simulator/plan/plan.h"

namespace faultsim {

/// Refuses a plan that does not fit before hours are spent on it: ResourceError with what the
/// operator needs, what there is, and the cure.
/// @param available  bytes; none = not checked.
void require_memory(const Plan& plan, std::optional<double> available);

}  // namespace faultsim
