#include "simulator/common/process_memory.h"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// The soft limit in a line of /proc/self/limits that begins with the name; none if unlimited.
std::optional<double> soft_limit(const std::string& line, const std::string& name) {
  double value = 0;
  if (line.rfind(name, 0) != 0) return std::nullopt;
  if (std::istringstream(line.substr(name.size())) >> value) return value;
  return std::nullopt;
}

}  // namespace

ProcessMemory process_memory(const std::filesystem::path& proc) {
  constexpr double kKilobyte = 1024;
  ProcessMemory memory;
  std::ifstream status(proc / "self" / "status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream text(line);
    std::string key;
    double kilobytes = 0;
    if (!(text >> key >> kilobytes)) continue;
    if (key == "VmSize:") memory.address_space = kKilobyte * kilobytes;
    if (key == "VmData:") memory.data = kKilobyte * kilobytes;
  }
  return memory;
}

std::optional<double> left_in_limits(const std::filesystem::path& proc) {
  const ProcessMemory used = process_memory(proc);
  std::optional<double> least;
  const auto keep = [&](std::optional<double> limit, double has) {
    if (!limit) return;
    const double left = std::max(0.0, *limit - has);
    if (!least || left < *least) least = left;
  };
  std::ifstream limits(proc / "self" / "limits");
  for (std::string line; std::getline(limits, line);) {
    keep(soft_limit(line, "Max data size"), used.data);
    keep(soft_limit(line, "Max address space"), used.address_space);
  }
  return least;
}

void limit_memory(double bytes) {
  const double used = process_memory().data;
  if (bytes - used < kLeastWorkingBytes) {
    throw ResourceError(
        concat("not enough memory: under a limit of ", std::llround(bytes / 1e6),
               " MB the simulator, which uses ", std::llround(used / 1e6),
               " MB at its start, can do nothing; give it at least ",
               std::llround(std::max(used + kLeastWorkingBytes, kLeastMemoryLimit) / 1e6), " MB"));
  }
  struct rlimit limit = {};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = static_cast<rlim_t>(bytes);
  if (limit.rlim_max != RLIM_INFINITY) limit.rlim_cur = std::min(limit.rlim_cur, limit.rlim_max);
  if (setrlimit(RLIMIT_DATA, &limit) != 0) {
    throw ResourceError(concat("cannot limit the memory of this process: ", std::strerror(errno)));
  }
}

}  // namespace faultsim
