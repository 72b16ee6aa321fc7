#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/loads/field_history.h"
#include "simulator/operators/influence.h"
#include "simulator/result/result.h"

namespace faultsim {

/// The plan of a scene that is sound. Throws InputError where it cannot be planned.
Plan exact_plan(const Scene& scene);

/// The cases of /numerics/surface/probes as scenes.
struct ProbingScenes {
  int n = 0;
  /// The i-th with the surface's parameters as they are in `at`; without a surface.
  std::function<Scene(int i, const Scene& at)> scene;
};

/// Runs these cases on exact and on interpolated operators, again and again as a surface grows:
/// their scenes, and the loads of flow results, are made once. Loads are exact on both operators:
/// their own errors are measured apart (FieldSurface).
class CaseRunner {
 public:
  /// @param scene_at  the exact scene with the surface's parameters at x in [-1, 1]^d.
  /// @pre scenes and cache outlive this.
  CaseRunner(const ProbingScenes& scenes, std::function<Scene(const Eigen::VectorXd& x)> scene_at,
             const CachePolicy& cache, StopToken stop);

  /// The i-th case at x on an operator that is there.
  CaseResult run(int i, const Eigen::VectorXd& x, const std::shared_ptr<const FaultOperator>& op);

 private:
  using Place = std::vector<double>;  ///< x.
  struct Case {
    Scene scene;
    std::shared_ptr<const FieldHistory> loads;  ///< of its flow result; null without.
  };
  Case made(int i, const Place& place, const Scene& at);
  const PreparedInfluence& influence_at(const Place& place, const SceneBulk& bulk);

  const ProbingScenes& scenes_;
  std::function<Scene(const Eigen::VectorXd& x)> scene_at_;
  const CachePolicy& cache_;
  RunContext quiet_;
  std::map<std::pair<int, Place>, Case> cases_;
  Place influence_place_;  ///< of influence_; empty: there is none.
  PreparedInfluence influence_;
};

}  // namespace faultsim
