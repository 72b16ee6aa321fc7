#pragma once

#include "simulator/contact/contact.h"
#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// Turns a jump that the contact solver followed into an event: sizes, place and evidence.
/// Step, stage, time and pressure are for the caller, who knows the loading.
SlipEvent measure_event(const FaultOperator& op, const ContactLaws& laws, const ContactJump& jump);

/// The node of the nucleus nearest to its centre, along dip and strike; -1 without a nucleus.
int nucleus_node(const FaultGeometry& geometry, const ContactJump& jump);

/// Largest cell edge over nucleation length of a node under a normal traction: edge_dip with the
/// modulus of mode II, edge_strike with that of mode III; 0 where it does not weaken.
double nucleation_ratio(const OperatorNode& node, const NodeLaw& law, bool plane_strain,
                        double normal_traction);

}  // namespace faultsim
