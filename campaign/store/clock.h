#pragma once

#include <chrono>

namespace faultsweep {

/// Time of day for rows of the store; never part of a result.
inline double seconds_since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace faultsweep
