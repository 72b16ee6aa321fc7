#pragma once

#include <functional>
#include <memory>

#include "simulator/simulation/operator_source.h"

namespace faultsim {

/// The making of an operator in a thread of its own, so that who waits for it can be called off at
/// once: some of its stages (METIS, the analysis of the factor, the mesh) ask for nothing for a
/// second.
class OperatorBuild {
 public:
  /// Starts it. @param make  may outlive the caller's wait: what it refers to is its own.
  OperatorBuild(std::function<OperatorSource::Made(const RunContext&)> make, int n_threads);
  /// Calls it off and waits for its end.
  ~OperatorBuild();
  OperatorBuild(const OperatorBuild&) = delete;
  OperatorBuild& operator=(const OperatorBuild&) = delete;

  /// The operator, or what was thrown instead. What the build tells goes on to the context's
  /// monitor, in this thread. Throws Interrupted within a few milliseconds of the context's stop;
  /// the build is then called off and ends by itself at its next look.
  OperatorSource::Made wait(const RunContext& context);
  /// Waits for the end of a build that was called off. Throws Interrupted likewise.
  void wait_for_end(const RunContext& context);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace faultsim
