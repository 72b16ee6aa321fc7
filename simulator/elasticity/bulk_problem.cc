#include "simulator/elasticity/bulk_problem.h"

#include "simulator/common/errors.h"

namespace faultsim {

int pressure_region(const BulkProblem& problem, int cell) {
  const int region = problem.mesh.region[cell];
  if (region < 0 || problem.mesh.region_fraction[cell] == 0) return -1;
  for (const LoadCase& load : problem.loads) {
    if (load.region == region) return load.key.index;
  }
  return -1;
}

Eigen::VectorXd unit_load(const BulkProblem& problem, const DofMap& dofs, int index) {
  const LoadCase& load = problem.loads[index];
  const int n_kinds = (load.region >= 0) + !load.stress_groups.empty() + load.displacement;
  FAULTSIM_DEMAND(n_kinds == 1, "load ", to_string(load.key), " is of ", n_kinds, " kinds");
  if (load.region >= 0) return pressure_load(problem.mesh, dofs, load.region);
  if (load.displacement) {
    return displacement_load(problem.mesh, problem.materials, dofs, index, problem.mean_dilatation);
  }
  return stress_load(problem.mesh, dofs, load.stress_groups, load.stress);
}

}  // namespace faultsim
