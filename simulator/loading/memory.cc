#include "simulator/loading/memory.h"

#include <cstdio>
#include <fstream>
#include <sstream>

#include "simulator/common/errors.h"
#include "simulator/common/process_memory.h"

namespace faultsim {
namespace {

void keep_least(std::optional<double>& least, double value) {
  if (!least || value < *least) least = value;
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

/// What a group may still take; pages that the kernel can drop at once (inactive files) do not
/// count.
std::optional<double> left_in_group(const std::filesystem::path& folder, bool v2) {
  const auto limit = number_in(folder / (v2 ? "memory.max" : "memory.limit_in_bytes"));
  const auto used = number_in(folder / (v2 ? "memory.current" : "memory.usage_in_bytes"));
  if (!limit || !used) return std::nullopt;
  const auto droppable =
      entry_in(folder / "memory.stat", v2 ? "inactive_file" : "total_inactive_file", 1);
  return *limit - *used + droppable.value_or(0);
}

std::string size_text(double bytes) {
  char text[32];
  if (bytes < 1e9) {
    std::snprintf(text, sizeof text, "%.0f MB", bytes / 1e6);
  } else {
    std::snprintf(text, sizeof text, "%.1f GB", bytes / 1e9);
  }
  return text;
}

}  // namespace

std::optional<double> available_memory(const std::filesystem::path& proc,
                                       const std::filesystem::path& cgroup) {
  std::optional<double> least = entry_in(proc / "meminfo", "MemAvailable:", 1024);
  if (const auto left = left_in_limits(proc)) keep_least(least, *left);
  std::ifstream groups(proc / "self" / "cgroup");
  for (std::string line; std::getline(groups, line);) {  // "0::/a/b" or "7:memory:/a/b"
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool v2 = controllers.empty();
    if (!v2 && ("," + controllers + ",").find(",memory,") == std::string::npos) continue;
    const std::filesystem::path base = v2 ? cgroup : cgroup / "memory";
    std::filesystem::path group = std::filesystem::path(line.substr(second + 1)).relative_path();
    for (;; group = group.parent_path()) {
      if (const auto left = left_in_group(base / group, v2)) keep_least(least, *left);
      if (group.empty()) break;
    }
  }
  return least;
}

void demand_memory(const Plan& plan, std::optional<double> available) {
  if (!available || plan.memory_bytes <= *available) return;
  const bool creeps = plan.creep.active;
  const std::string what =
      creeps ? concat("the ", 1 + plan.creep.rungs.size(),
                      " operators of this scene, one per step length of creep and the elastic one, "
                      "need about ",
                      size_text(plan.memory_bytes), " together (")
             : concat("the operator of this scene needs about ", size_text(plan.memory_bytes),
                      " while it is built (");
  throw ResourceError(
      concat("not enough memory: ", what, plan.n_unknowns, " unknowns, ", plan.n_jump,
             " of them jumps), ", size_text(*available), " are available; ",
             plan.plane_strain ? "choose larger cells (/mesh)"
                               : "choose a coarser tier or larger cells (/mesh), or plane strain "
                                 "(for a field the tier \"screening\")",
             creeps ? ", or fewer step lengths (/numerics/creep_refinements, or fixed steps by "
                      "/numerics/creep_time_step)"
                    : ""));
}

}  // namespace faultsim
