#include "simulator/common/machine.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "simulator/common/process_memory.h"

namespace faultsim {
namespace {

void keep_least(std::optional<double>& least, std::optional<double> value) {
  if (value && (!least || *value < *least)) least = value;
}

/// The number that a file begins with; none when absent or "max".
std::optional<double> number_in(const std::filesystem::path& path) {
  std::ifstream file(path);
  double value = 0;
  if (file >> value) return value;
  return std::nullopt;
}

/// Bytes behind "KEY:" or "KEY " in a file of lines; unit is what one count means.
std::optional<double> entry_in(const std::filesystem::path& path, const std::string& key,
                               double unit) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream text(line);
    std::string word;
    double value = 0;
    if (text >> word >> value && word == key) return unit * value;
  }
  return std::nullopt;
}

/// Visits the folders of the process's group (v2, or the v1 controller) up to the root, each with
/// whether it is of v2.
template <typename Visit>
void for_each_group(const std::filesystem::path& proc, const std::filesystem::path& cgroup,
                    const std::string& controller, const Visit& visit) {
  std::ifstream groups(proc / "self" / "cgroup");
  for (std::string line; std::getline(groups, line);) {  // "0::/a/b" or "7:memory:/a/b"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool is_v2 = controllers.empty();
    if (!is_v2 && ("," + controllers + ",").find("," + controller + ",") == std::string::npos) {
      continue;
    }
    const std::filesystem::path base = is_v2 ? cgroup : cgroup / controller;
    std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    for (;; group = group.parent_path()) {
      visit(base / group, is_v2);
      if (group.empty()) break;
    }
  }
}

/// What a group may still take; pages that the kernel can drop at once (inactive files) do not
/// count.
std::optional<double> left_in_group(const std::filesystem::path& folder, bool is_v2) {
  const auto limit = number_in(folder / (is_v2 ? "memory.max" : "memory.limit_in_bytes"));
  const auto used = number_in(folder / (is_v2 ? "memory.current" : "memory.usage_in_bytes"));
  if (!limit || !used) return std::nullopt;
  const auto droppable =
      entry_in(folder / "memory.stat", is_v2 ? "inactive_file" : "total_inactive_file", 1);
  return *limit - *used + droppable.value_or(0);
}

/// cpu.max holds "max 100000" or "150000 100000".
std::optional<double> quota_of_group(const std::filesystem::path& folder, bool is_v2) {
  double quota = 0, period = 0;
  if (is_v2) {
    std::ifstream file(folder / "cpu.max");
    if (!(file >> quota >> period)) return std::nullopt;
  } else {
    quota = number_in(folder / "cpu.cfs_quota_us").value_or(0);
    period = number_in(folder / "cpu.cfs_period_us").value_or(0);
  }
  if (quota <= 0 || period <= 0) return std::nullopt;
  return quota / period;
}

}  // namespace

std::optional<double> available_memory(const std::filesystem::path& proc,
                                       const std::filesystem::path& cgroup) {
  constexpr double kKilobyte = 1024;
  std::optional<double> least = entry_in(proc / "meminfo", "MemAvailable:", kKilobyte);
  keep_least(least, left_in_limits(proc));
  for_each_group(proc, cgroup, "memory", [&](const std::filesystem::path& folder, bool is_v2) {
    keep_least(least, left_in_group(folder, is_v2));
  });
  return least;
}

std::optional<double> cgroup_cpus(const std::filesystem::path& proc,
                                  const std::filesystem::path& cgroup) {
  std::optional<double> least;
  for_each_group(proc, cgroup, "cpu", [&](const std::filesystem::path& folder, bool is_v2) {
    keep_least(least, quota_of_group(folder, is_v2));
  });
  return least;
}

int usable_cores() {
  cpu_set_t mask;
  CPU_ZERO(&mask);
  int cores = 1;
  if (sched_getaffinity(0, sizeof mask, &mask) == 0) cores = CPU_COUNT(&mask);
  constexpr double kRounding = 0.01;
  if (const auto quota = cgroup_cpus()) {
    cores = std::min(cores, static_cast<int>(std::floor(*quota + kRounding)));
  }
  return std::max(1, cores);
}

}  // namespace faultsim
