#pragma once

#include "simulator/contact/contact_state.h"
#include "simulator/laws/friction_law.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// Rest under no load.
ContactState initial_state(const FaultOperator& op);
/// What the friction of a node remembers at the end of a step. @param node  number k of the
/// operator.
FrictionState friction_state(const OperatorNode& node, const ContactState& state, int k);

}  // namespace faultsim
