#include "simulator/plan/geometry_check.h"

#include <algorithm>

#include "simulator/elasticity/held.h"
#include "simulator/plan/boundary_conditions.h"

namespace faultsim {

std::vector<Problem> geometry_problems(const Scene& scene, const Plan& plan,
                                       std::shared_ptr<const Mesh>* made) {
  if (scene.numerics.surface.wanted()) {
    if (auto problems = surface_problems(scene, plan); !problems.empty()) return problems;
  }
  if (plan.n_cells > kMostCellsChecked) return {};
  try {
    const auto mesh = std::make_shared<const Mesh>(scene_mesh(scene, plan));
    const auto n_loads = std::ranges::count_if(scene.box.boundary,
                                               [](const auto& one) { return is_load(one.kind); });
    const DofMap dofs(*mesh, displacement_conditions(scene, 0), static_cast<int>(n_loads));
    require_held(*mesh, dofs);
    if (made != nullptr) *made = mesh;
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace faultsim
