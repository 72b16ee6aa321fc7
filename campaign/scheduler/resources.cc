#include "campaign/scheduler/resources.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "campaign/common/names.h"
#include "simulator/common/machine.h"

namespace faultsweep {

std::optional<int> slurm_number(const char* text) {
  if (text == nullptr) return std::nullopt;
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (end == text || value <= 0 || (*end != '\0' && *end != '(' && *end != ','))
    return std::nullopt;
  return static_cast<int>(std::min(value, 100000000L));
}

int available_cores() {
  int cores = faultsim::usable_cores();
  const auto tasks = slurm_number(std::getenv("SLURM_NTASKS"));
  const auto per_task = slurm_number(std::getenv("SLURM_CPUS_PER_TASK"));
  const auto on_node = slurm_number(std::getenv("SLURM_CPUS_ON_NODE"));
  const auto nodes = slurm_number(std::getenv("SLURM_JOB_NUM_NODES"));
  if (tasks && *tasks > 1) {
    cores =
        *tasks * per_task.value_or(1);  // may be on several hosts: the affinity here says nothing
  } else if (per_task) {
    cores = std::min(cores, *per_task);
  } else if (on_node) {
    cores = nodes.value_or(1) > 1 ? *on_node * *nodes : std::min(cores, *on_node);
  }
  return std::max(1, cores);
}

int default_workers() {
  const auto tasks = slurm_number(std::getenv("SLURM_NTASKS"));
  return tasks && *tasks > 1 ? *tasks - 1 : available_cores();
}

namespace {

/// --mem and --mem-per-cpu in MB; a job's cgroup need not enforce them.
std::optional<double> slurm_memory() {
  constexpr double kMegabyte = 1024 * 1024;
  if (const auto node = slurm_number(std::getenv("SLURM_MEM_PER_NODE"))) return kMegabyte * *node;
  const auto per_core = slurm_number(std::getenv("SLURM_MEM_PER_CPU"));
  const auto cores = slurm_number(std::getenv("SLURM_CPUS_ON_NODE"));
  if (per_core && cores) return kMegabyte * *per_core * *cores;
  return std::nullopt;
}

}  // namespace

std::optional<double> available_memory() {
  std::optional<double> least = faultsim::available_memory();
  if (const auto job = slurm_memory(); job && (!least || *job < *least)) least = job;
  if (least) least = std::max(0.0, *least);
  return least;
}

std::optional<double> physical_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || bytes <= 0) return std::nullopt;
  return static_cast<double>(pages) * static_cast<double>(bytes);
}

MemoryForOperators memory_for_operators(std::optional<double> available,
                                        std::optional<double> physical) {
  constexpr double kShareOfPhysical = 0.5, kGigabyte = 1e9;
  constexpr double kLeast = 1;  // byte: 0 would mean no limit; operators are then built one by one
  if (available) return {std::max(kLeast, kMemoryShare * *available), ""};
  const std::string unknown = "it is not known how much memory is available";
  if (!physical) return {0, unknown + ": operators are not limited; give --memory"};
  const double bytes = kShareOfPhysical * *physical;
  return {bytes, concat(unknown, ": operators may have half of the physical memory, ",
                        formatted("%.1f", bytes / kGigabyte), " GB, unless --memory is given")};
}

}  // namespace faultsweep
