#pragma once

#include <filesystem>
#include <optional>

/// What this process may use, which is less than its machine has.
namespace faultsim {

/// Bytes that this process may still take: the least of MemAvailable, its own limits and, on the
/// way from its control group to the root, limit less use (group v2 and v1). None = nobody says.
/// @param proc, cgroup  where the kernel shows them; others in tests.
std::optional<double> available_memory(const std::filesystem::path& proc = "/proc",
                                       const std::filesystem::path& cgroup = "/sys/fs/cgroup");

/// CPUs granted by the tightest cpu.max (cgroup v2) or cpu.cfs_quota_us (v1) on the way from the
/// process's group to the root; none = not limited.
std::optional<double> cgroup_cpus(const std::filesystem::path& proc = "/proc",
                                  const std::filesystem::path& cgroup = "/sys/fs/cgroup");

/// Cores of its affinity mask, at most what cgroup_cpus grants; at least 1.
int usable_cores();

}  // namespace faultsim
