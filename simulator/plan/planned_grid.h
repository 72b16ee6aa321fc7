#pragma once

#include <optional>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/plan/cost.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// What the cells of a scene are to the factorisation, without the mesh.
struct PlannedGrid {
  GridShape shape;
  long n_cells;
  double n_loaded;  ///< cells of compartments, about.
};

/// Nothing where grid lines are impossible, which is said.
std::optional<PlannedGrid> planned_grid(const Scene& scene, const Plan& plan,
                                        std::vector<Problem>& problems);

}  // namespace faultsim
