#pragma once

#include "simulator/elasticity/bulk_problem.h"

namespace faultsim {

/// The mesh-refinement study of Ferronato et al. (SIAM GS 2019): a 5 × 2 × 1 m box of cubic cells
/// h, cut by the plane z = ½, 0 ≤ x ≤ 4, 0 ≤ y ≤ 2, whose tip line x = 4 is not split. They give
/// neither material nor boundary conditions; ours: E = 10 GPa, ν = 0.25, the base z = 0 held, all
/// else free; load 0 is 1 MPa of compression and 0.5 MPa of shear along x on the top.
/// @param cells_per_metre  1/h ≥ 2, even.
BulkProblem box_study(int cells_per_metre);

}  // namespace faultsim
