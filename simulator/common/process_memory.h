#pragma once

#include <filesystem>
#include <optional>

namespace faultsim {

/// What OpenBLAS takes as its work buffer, bytes: BUFFER_SIZE of Debian's 0.3.21 on x86-64.
inline constexpr double kBlasBufferBytes = 134217728;
/// What the smallest scene needs beside it, bytes: program, scene, mesh, result.
inline constexpr double kLeastWorkingBytes = 64e6;
/// The least limit under which a simulator process can be of use, bytes.
inline constexpr double kLeastMemoryLimit = 200e6;
static_assert(kLeastMemoryLimit > kBlasBufferBytes + kLeastWorkingBytes);

/// What this process has, as its limits count it, bytes.
struct ProcessMemory {
  double address_space = 0;  ///< RLIMIT_AS, ulimit -v: all that is mapped.
  double data = 0;           ///< RLIMIT_DATA, ulimit -d: private memory that can be written.
};
ProcessMemory process_memory(const std::filesystem::path& proc = "/proc");

/// Bytes that RLIMIT_AS and RLIMIT_DATA still leave to this process; none = not limited.
/// @param proc  where "self/limits" and "self/status" are read.
std::optional<double> left_in_limits(const std::filesystem::path& proc = "/proc");

/// Limits the private memory (RLIMIT_DATA) of this process; what it has already counts.
/// @throws ResourceError if fewer than kLeastWorkingBytes would be left.
void limit_memory(double bytes);

}  // namespace faultsim
