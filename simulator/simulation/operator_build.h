#pragma once

#include <functional>
#include <memory>

#include "simulator/loading/run_case.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// prepare_operator in a thread of its own, so that who waits for it can be called off at once:
/// some of its stages (METIS, the analysis of the factor, the mesh) ask for nothing for a second.
class OperatorBuild {
 public:
  /// Starts it. Scene and plan are copied.
  OperatorBuild(const Scene& scene, const Plan& plan, const CachePolicy& cache, bool keep_bulk,
                int n_threads);
  /// The same of other work that ends with an operator, or keeps what it made elsewhere.
  OperatorBuild(std::function<PreparedOperator(const RunContext&)> make, int n_threads);
  /// Calls it off and waits for its end.
  ~OperatorBuild();
  OperatorBuild(const OperatorBuild&) = delete;
  OperatorBuild& operator=(const OperatorBuild&) = delete;

  /// The operator, or what was thrown instead. What the build tells goes on to the context's
  /// monitor, in this thread. Throws Interrupted within a few milliseconds of the context's stop;
  /// the build is then called off and ends by itself at its next look.
  PreparedOperator wait(const RunContext& context);
  /// Waits for the end of a build that was called off. Throws Interrupted likewise.
  void wait_for_end(const RunContext& context);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace faultsim
