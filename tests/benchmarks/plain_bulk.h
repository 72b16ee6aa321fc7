#pragma once

#include <vector>

#include "simulator/condensation/condensation.h"

namespace faultsim::benchmarks {

/// The plain alternative to condensing: the same K, its jump unknowns ordered by METIS with all
/// others.
struct PlainBulk {
  DofMap dofs;
  SparseMatrix k;
  UnknownGroups groups;

  TrailingCholesky factorised() const { return TrailingCholesky(k, 0, groups); }
};

inline PlainBulk plain_bulk(const BulkProblem& problem) {
  DofMap dofs(problem.mesh, problem.conditions, static_cast<int>(problem.loads.size()));
  SparseMatrix k =
      assemble_stiffness(problem.mesh, problem.materials, dofs, problem.mean_dilatation);
  UnknownGroups groups = dofs.bulk_groups();
  for (int g = 0; g < dofs.n_jump(); ++g) groups.of.push_back(groups.n + g / 3);
  groups.n += (dofs.n_jump() + 2) / 3;
  if (!groups.ends.empty()) groups.ends.resize(groups.n, {-1, -1});
  return {std::move(dofs), std::move(k), std::move(groups)};
}

}  // namespace faultsim::benchmarks
