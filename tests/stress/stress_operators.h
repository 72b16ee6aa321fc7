#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulator/model/fault_operator.h"

namespace faultsim {

struct StressOperator {
  std::string name;
  std::shared_ptr<const FaultOperator> op;
};

/// Small operators of real scenes, 10 to 80 fault nodes, made on first use by the simulator's own
/// road (scene, plan, condensation): plane strain and 3D, dips both ways, offset compartments, two
/// faults beside each other, soft beside stiff rock, a patch cut by a roller. Simplest first.
const std::vector<StressOperator>& stress_operators();

}  // namespace faultsim
