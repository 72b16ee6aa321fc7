#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "python/bindings/kept_result.h"
#include "simulator/simulation/inside.h"

namespace faultsim::python {

/// A simulation for one thread of Python's at a time.
struct HeldSimulation {
  std::atomic<bool> is_busy = false;
  Simulation simulation;
  CachePolicy cache;
};

}  // namespace faultsim::python
