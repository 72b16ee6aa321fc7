#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace faultsweep {

/// What this process may use, which is less than the host has: affinity mask, cgroup quota and the
/// share of a Slurm job.
/// At least 1.
int available_cores();
/// Bytes: the lesser of the host's available memory and the cgroup's limit less its use; 0 =
/// unknown.
double available_memory();

/// CPUs granted by the tightest cpu.max (cgroup v2) or cpu.cfs_quota_us (v1) on the way from the
/// process's group to the root; none = not limited.
/// @param root     usually /sys/fs/cgroup.
/// @param groups   text of /proc/self/cgroup.
std::optional<double> cgroup_cpus(const std::filesystem::path& root, const std::string& groups);
/// The number in a Slurm variable: "8", "8(x2)" -> 8; none when absent or odd.
std::optional<int> slurm_number(const char* text);

}  // namespace faultsweep
