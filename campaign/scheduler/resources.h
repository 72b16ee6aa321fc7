#pragma once

#include <optional>

namespace faultsweep {

/// What this process may use, which is less than the host has: affinity mask, cgroup quota and the
/// share of a Slurm job.
/// At least 1.
int available_cores();
/// Workers beside a manager that mostly sleeps: one per core. In a Slurm job of several tasks the
/// manager is one of them.
int default_workers();
/// Bytes: the least of the host's available memory, the cgroup's limit less its use, and what Slurm
/// gives the job on a node; 0 = unknown.
double available_memory();
/// Of what is available when a campaign starts, operators may have this; the rest is for results
/// and cache.
inline constexpr double kMemoryShare = 0.9;

/// The number in a Slurm variable: "8", "8(x2)" -> 8; none when absent or odd.
std::optional<int> slurm_number(const char* text);

}  // namespace faultsweep
