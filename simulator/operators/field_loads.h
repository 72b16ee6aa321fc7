#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/flow/flow_mapping.h"
#include "simulator/loads/field_history.h"
#include "simulator/operators/influence.h"

namespace faultsim {

/// How a flow result is taken.
struct FieldChoice {
  OutsideRule outside = OutsideRule::nearest;
  int reference = 0;  ///< report whose pressures are the scene's initial ones: Δp = 0.
  /// Reports are left out whose locked tractions and fault pressures lie within this of the line
  /// between their neighbours, Pa; 0 = only what is on the line.
  double bound = 0;
};

/// A flow result on the faults of a scene.
struct FieldLoads {
  FieldHistory history;      ///< of the reports that are needed; time 0 = the reference report.
  std::vector<int> reports;  ///< their numbers in the flow result, from the reference on.
  FlowMapping mapping;
};

/// Maps the flow result onto the block's cells and condenses it: s_c = b f_c Δp_c with the share
/// f_c of the cell in its compartment, one product per report from the reference on; Δp_f of a
/// fault node is its faults' rule on the pairs of cells beside it, as for compartments. Neither
/// strength nor friction is looked at, so that samples of them share it; Biot coefficients and
/// fault pressure rules are.
/// @pre the block has all cells of the compartments; scene and plan are its own.
/// @throws InputError for a half domain, which has no room for a field that is not symmetric, for a
/// reference that is no report, and as map_flow() does.
FieldLoads field_loads(const Scene& scene, const Plan& plan, const PreparedInfluence& prepared,
                       const FlowField& field, const FieldChoice& choice, int n_threads = 1);

}  // namespace faultsim
