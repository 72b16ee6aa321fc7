#pragma once

#include <time.h>

namespace faultsim::benchmarks {

inline double seconds_of(clockid_t clock) {
  timespec now = {};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds of the wall clock, from any origin.
inline double wall_seconds() { return seconds_of(CLOCK_MONOTONIC); }
/// CPU seconds of this process so far: they leave out other processes and waiting for the disk.
inline double cpu_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace faultsim::benchmarks
