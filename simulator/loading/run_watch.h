#pragma once

#include <Eigen/Core>
#include <functional>

#include "simulator/contact/search_record.h"
#include "simulator/result/result.h"

namespace faultsim {

/// Called after each load step in equilibrium.
using StepObserver = std::function<void(const StepResult&, const FaultFields&)>;

/// Who looks on while a case runs; the result does not depend on it. Called by the thread that
/// runs.
struct RunWatch {
  StepObserver step = nullptr;
  /// After each try at a part of a load step, with the step's number (docs/trace.md).
  std::function<void(int, const SubStepTrace&)> tried = nullptr;
  /// At the end of each stage, and of step 0, with the displacement of all mesh nodes, m, 3 x
  /// n_nodes: where that is on a condensed operator, its bulk was kept.
  std::function<void(const StepResult&, const Eigen::Matrix3Xd&)> displaced = nullptr;
};

}  // namespace faultsim
