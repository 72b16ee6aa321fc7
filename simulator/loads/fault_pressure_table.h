#pragma once

#include "simulator/initial_state/fault_pressure.h"
#include "simulator/model/fault_operator.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// Where a node is in the table of its fault: depth or distance down dip from the centre of the
/// patch, and distance along strike from that centre (field: y), m.
struct TablePlace {
  double dip = 0, strike = 0;
};
TablePlace place_in_table(const Scene& scene, std::size_t fault, const OperatorNode& node);

}  // namespace faultsim
