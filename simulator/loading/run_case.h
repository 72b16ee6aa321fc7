#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "simulator/common/monitor.h"
#include "simulator/condensation/condensation.h"
#include "simulator/output/fault_operator.h"
#include "simulator/output/result.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// The family of a scene turned into numbers for the bulk.
BulkProblem bulk_problem(const Scene& scene, const Plan& plan);

/// Where operators are kept; an empty folder = nowhere.
struct CachePolicy {
  std::filesystem::path folder;
  std::uint64_t max_bytes = 20'000'000'000;
};

/// The operator of the scene: from the cache if it is there and sound, else built (and cached).
/// Throws ResourceError before anything is built when the plan needs more memory than is available;
/// a cache that cannot be written is a remark.
struct PreparedOperator {
  std::shared_ptr<const FaultOperator> op;
  std::shared_ptr<CondensedBulk> bulk;  ///< only when keep_bulk was asked (displacement fields).
  bool from_cache = false;
  std::string remark;  ///< "damaged operator file moved aside", "not kept", ...
};
PreparedOperator prepare_operator(const Scene& scene, const Plan& plan, const CachePolicy& cache,
                                  bool keep_bulk, Monitor& monitor);

/// Called after each load step in equilibrium.
using StepObserver = std::function<void(const StepResult&, const FaultFields&)>;

/// Runs one case on its operator: initial state, load steps, contact, metrics. Deterministic: the
/// same scene and operator give the same bits whatever ran before. Never throws for
/// non-convergence.
CaseResult run_case(const Scene& scene, const FaultOperator& op, Monitor& monitor,
                    const StepObserver& observer = {});

}  // namespace faultsim
