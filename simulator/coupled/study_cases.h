#pragma once

#include <vector>

#include "simulator/common/words.h"
#include "simulator/coupled/saddle_point.h"

namespace faultsim {

/// Stand-ins for the field cases of Ferronato et al. (SIAM GS 2019), whose meshes are not public:
/// as many unknowns and multipliers to 3 %, from our own generator. Ours are hexahedra with twice
/// their entries per row.
enum class StudyCase {
  box,      ///< the cracked box, see box_study.h.
  cuts15,   ///< "15 discontinuities": cubes of 10 m, cut in 15 of 18 planes up to a rim of nodes.
  field_a,  ///< "Mexico": three parallel faults that dip by 20°, cells graded away from them.
  field_b,  ///< "China": two such faults.
  field_c   ///< "Italy": five.
};
constexpr auto words(StudyCase) {
  return std::array{"box", "15-cuts", "field-a", "field-b", "field-c"};
}

/// E = 10 GPa, ν = 0.25, the base held, all else free; load 0 is 1 MPa of compression and 0.5 MPa
/// of shear along x on the top. @param which  any but box (InternalError).
BulkProblem study_case(StudyCase which);

/// What a history comes by: how the nodes of each fault stand at one of its steps.
enum class FaultStage {
  stick,  ///< all stick.
  slip,   ///< those in the middle, seven tenths of the fault's length and width, slip.
  open    ///< of these, those in the middle half are open.
};
constexpr auto words(FaultStage) { return std::array{"stick", "slip", "open"}; }

/// Slip is that of a crack, 10 mm in the middle, under 3 MPa, with friction that weakens a little.
/// @return one per node of TwoSidedBulk::fault_nodes(), in its order.
std::vector<NodeLinearisation> stage_of(const Mesh& mesh, FaultStage stage);

}  // namespace faultsim
