#pragma once

#include <vector>

#include "simulator/condensation/condensation.h"

namespace faultsim::benchmarks {

/// The plain alternative to condensing: the same K, its jump unknowns ordered by METIS with all
/// others.
struct PlainBulk {
  DofMap dofs;
  SparseMatrix k;
  std::vector<int> group;
  int n_groups = 0;

  TrailingCholesky factorised() const { return TrailingCholesky(k, 0, group, n_groups); }
};

inline PlainBulk plain_bulk(const BulkProblem& problem) {
  DofMap dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size()));
  SparseMatrix k =
      assemble_stiffness(problem.mesh, problem.materials, dofs, problem.mean_dilatation);
  std::vector<int> group = dofs.bulk_group();
  const int n_groups = dofs.n_groups();
  for (int g = 0; g < dofs.n_jump(); ++g) group.push_back(n_groups + g / 3);
  const int n_jump_groups = (dofs.n_jump() + 2) / 3;
  return {std::move(dofs), std::move(k), std::move(group), n_groups + n_jump_groups};
}

}  // namespace faultsim::benchmarks
