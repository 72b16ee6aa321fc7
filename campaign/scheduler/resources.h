#pragma once

#include <optional>
#include <string>

namespace faultsweep {

/// What this process may use, which is less than the host has: affinity mask, cgroup quota and the
/// share of a Slurm job.
/// At least 1.
int available_cores();
/// Workers beside a manager that mostly sleeps: one per core. In a Slurm job of several tasks the
/// manager is one of them.
int default_workers();
/// Bytes: the least of the host's available memory, the cgroup's limit less its use, and what Slurm
/// gives the job on a node; none = nobody says.
std::optional<double> available_memory();
/// Of the machine, whoever uses it; none = not known.
std::optional<double> physical_memory();

/// What operators may have together on a host.
struct MemoryForOperators {
  double bytes = 0;    ///< 0 = not limited.
  std::string remark;  ///< what is assumed where it is not known what is available; "" = it is.
};
/// Of the available memory that operators may take.
inline constexpr double kMemoryShare = 0.9;

/// kMemoryShare of what is available when a campaign starts: the rest is for results and cache.
/// Half of the physical memory where that is not known.
MemoryForOperators memory_for_operators(std::optional<double> available,
                                        std::optional<double> physical);

/// The number in a Slurm variable: "8", "8(x2)" -> 8; none when absent or odd.
std::optional<int> slurm_number(const char* text);

}  // namespace faultsweep
