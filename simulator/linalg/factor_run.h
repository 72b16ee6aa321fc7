#pragma once

#include <functional>

namespace faultsim {

class FactorAnalysis;

/// How a factorisation is carried out. Nothing of it changes a bit of the factor.
struct FactorRun {
  int n_threads = 1;                               ///< at most; small matrices take one.
  std::function<void(double)> progress = nullptr;  ///< fraction of the flops done; calling thread.
  std::function<bool()> stop = nullptr;            ///< true: end soon. Asked by all threads.
  FactorAnalysis* analysis = nullptr;              ///< of factors before, kept for those after.
};

}  // namespace faultsim
