#include "campaign/scheduler/resources.h"

#include <algorithm>
#include <cstdlib>

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

double available_memory() {
  std::optional<double> least = faultsim::available_memory();
  if (const auto job = slurm_memory(); job && (!least || *job < *least)) least = job;
  return std::max(0.0, least.value_or(0));
}

}  // namespace faultsweep
