#include "campaign/scheduler/resources.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace faultsweep {
namespace {

std::string first_line(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::optional<double> number_in(const std::filesystem::path& path) {
  std::istringstream text(first_line(path));
  double value = 0;
  if (text >> value) return value;
  return std::nullopt;
}

void keep_least(std::optional<double>& least, std::optional<double> value) {
  if (value && (!least || *value < *least)) least = value;
}

/// "max 100000" or "150000 100000".
std::optional<double> quota_v2(const std::filesystem::path& folder) {
  std::istringstream text(first_line(folder / "cpu.max"));
  double quota = 0, period = 0;
  if (text >> quota >> period && period > 0) return quota / period;
  return std::nullopt;
}

std::optional<double> quota_v1(const std::filesystem::path& folder) {
  const auto quota = number_in(folder / "cpu.cfs_quota_us");
  const auto period = number_in(folder / "cpu.cfs_period_us");
  if (quota && period && *quota > 0 && *period > 0) return *quota / *period;
  return std::nullopt;
}

std::string own_groups() {
  std::ifstream file("/proc/self/cgroup");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Folders from the process's group (v2, or the v1 controller) up to the root.
template <typename Visit>
void for_each_group(const std::filesystem::path& root, const std::string& groups,
                    const std::string& controller, const Visit& visit) {
  std::istringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool is_v2 = controllers.empty();
    if (!is_v2 && ("," + controllers + ",").find("," + controller + ",") == std::string::npos)
      continue;
    const std::filesystem::path base = is_v2 ? root : root / controller;
    std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    for (;; group = group.parent_path()) {
      visit(base / group, is_v2);
      if (group.empty()) break;
    }
  }
}

}  // namespace

std::optional<double> cgroup_cpus(const std::filesystem::path& root, const std::string& groups) {
  std::optional<double> least;
  for_each_group(root, groups, "cpu", [&](const std::filesystem::path& folder, bool is_v2) {
    keep_least(least, is_v2 ? quota_v2(folder) : quota_v1(folder));
  });
  return least;
}

std::optional<int> slurm_number(const char* text) {
  if (text == nullptr) return std::nullopt;
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (end == text || value <= 0 || (*end != '\0' && *end != '(' && *end != ','))
    return std::nullopt;
  return static_cast<int>(std::min(value, 100000000L));
}

int available_cores() {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  int cores = 1;
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) cores = CPU_COUNT(&mask);
  if (const auto quota = cgroup_cpus("/sys/fs/cgroup", own_groups())) {
    cores = std::min(cores, static_cast<int>(std::max(1.0, std::floor(*quota + 0.01))));
  }
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
  std::optional<double> least;
  std::ifstream meminfo("/proc/meminfo");
  for (std::string line; std::getline(meminfo, line);) {
    std::istringstream text(line);
    std::string key;
    double kilobytes = 0;
    if (text >> key >> kilobytes && key == "MemAvailable:") keep_least(least, 1024 * kilobytes);
  }
  for_each_group(
      "/sys/fs/cgroup", own_groups(), "memory",
      [&](const std::filesystem::path& folder, bool is_v2) {
        const auto limit = number_in(folder / (is_v2 ? "memory.max" : "memory.limit_in_bytes"));
        const auto used = number_in(folder / (is_v2 ? "memory.current" : "memory.usage_in_bytes"));
        if (limit) keep_least(least, *limit - used.value_or(0));
      });
  keep_least(least, slurm_memory());
  return std::max(0.0, least.value_or(0));
}

}  // namespace faultsweep
