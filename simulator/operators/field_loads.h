#pragma once

#include <string>
#include <vector>

#include "simulator/flow/flow_mapping.h"
#include "simulator/loads/field_history.h"
#include "simulator/operators/influence.h"

namespace faultsim {

/// A flow result on the faults of a scene.
struct FieldLoads {
  FieldHistory history;  ///< at the reports of pressure and temperature that the scene takes.
  FlowMapping mapping;   ///< of the pressure field, if there is one.
  double coverage = 1;   ///< share of the compartments' volume that is covered, [0, 1]; of pressure
                         ///< and temperature the smaller one.
  std::vector<std::string> notes;     ///< what became of the cells of each compartment.
  std::vector<std::string> warnings;  ///< of plan/field_check.h, left for who has looked there.
};

/// Maps the scene's fields onto the block's cells and condenses them: s_c = f_c (b Δp_c + 3 K α_T
/// ΔT_c) with the share f_c of the cell in its compartment, one product per report from the
/// reference on; Δp_f of a fault node is its fault's rule on the pairs of cells beside it, as for
/// compartments. Neither strength nor friction is looked at, so that samples of them share it; what
/// is looked at is told by field_loads_key().
/// @pre the block has all cells of the compartments; scene and plan are its own, the scene has a
/// flow result and the plan all of the domain.
/// @throws InputError as map_flow() does.
FieldLoads field_loads(const Scene& scene, const Plan& plan, const PreparedInfluence& prepared,
                       int n_threads = 1);

/// Scenes of one operator with the same key have the same field loads.
std::string field_loads_key(const Scene& scene);

}  // namespace faultsim
