#pragma once

#include <chrono>

namespace faultsim {

/// Wall-clock seconds since construction. Never part of a result that is compared bit by bit.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace faultsim
