#pragma once

#include <filesystem>
#include <optional>

#include "simulator/plan/plan.h"

namespace faultsim {

/// Bytes that this process may still take: the least of MemAvailable and, on the way from its
/// control group to the root, limit less use (group v2 and v1). None = nobody says.
/// @param proc, cgroup  where the kernel shows them; others in tests.
std::optional<double> available_memory(const std::filesystem::path& proc = "/proc",
                                       const std::filesystem::path& cgroup = "/sys/fs/cgroup");

/// Refuses a plan that does not fit before hours are spent on it: ResourceError with what the
/// operator needs, what there is, and the cure.
/// @param available  bytes; none = not checked.
void demand_memory(const Plan& plan, std::optional<double> available);

}  // namespace faultsim
