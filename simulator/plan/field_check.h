#pragma once

#include <string>
#include <vector>

#include "simulator/plan/plan.h"

namespace faultsim {

/// What flow results say of a scene's compartments and faults before anything is built.
struct FieldCheck {
  std::vector<Problem> problems;   ///< by pointer into the scene document, without lines.
  std::vector<Remark> remarks;     ///< what to know: parts that are not covered, pressures.
  std::vector<std::string> notes;  ///< how much of each compartment is covered.
};

/// Less than this of a compartment's volume is refused, unless the scene says `outside`: it would
/// be made of what lies beside it.
inline constexpr double kLeastCovered = 0.5;

/// Looks at the fields where they meet the compartments as a whole: of a field's blocks the exact
/// hexahedra between the faults (in plane strain their section), of a box the cells of its mesh.
/// Problems: a grid that meets no compartment, or less than kLeastCovered of one, with the cure;
/// flow cells that lie over each other; of IntegralRule::flow_grid integrals that cannot be kept,
/// in the cells of the mesh as a run has them (keep_integrals). Remarks: compartments that are not
/// covered whole; faults with less than kLeastCovered of the reservoir within 100 m of them
/// covered; of pressures, the initial state's plus the change since the reference, where and when
/// they rise most above the initial one, exceed the least principal stress most and fall below zero
/// most, looked at flow cell by flow cell; a reference report whose mean is 5 bar from the initial
/// pressure. Costs the overlaps of the flow cells with a few hexahedra, or with the cells of the
/// mesh. Nothing where there is no field. @pre scene and plan have no problems.
FieldCheck check_fields(const Scene& scene, const Plan& plan);

}  // namespace faultsim
