#pragma once

#include <string>

#include "simulator/coupled/coupled_solver.h"

namespace faultsim {

/// One preconditioner on one Jacobian, all nodes in stick.
struct StudyRow {
  SolverChoice choice;
  int n_displacements = 0, n_multipliers = 0;
  long leading_nonzeros = 0, constraint_nonzeros = 0;
  /// Iterations to a relative residual of 1e-6 and 1e-8; −1 = not within the limit.
  struct Counts {
    int to_1e6 = -1, to_1e8 = -1;
  };
  Counts random, physical;
  /// Seconds of the processor: the set-up, and the solve of the random right-hand side to 1e-8.
  double setup_seconds = 0, solve_seconds = 0;
  double true_residual = 1;  ///< the larger |b − J x| / |b| of both, computed, in scaled rows.
  double bytes = 0;          ///< on the heap that the preconditioner keeps after its set-up.
  std::string failure;       ///< why it could not be set up; counts are −1 then.
};

/// A right-hand side of J.
struct StudyLoad {
  Eigen::VectorXd f, g;  ///< n_u, N; n_λ, m3.
};
/// Entries evenly in [−1, 1], seed fixed, in all rows (scaled, as the solver sees them) but those
/// of prescribed displacements, which are 0.
StudyLoad random_load(const TwoSidedBulk& bulk, const SaddlePoint& j);
/// Load 0 of the bulk, g = 0.
StudyLoad physical_load(const TwoSidedBulk& bulk, const SaddlePoint& j);

/// Solves for both loads.
StudyRow study(const TwoSidedBulk& bulk, const SaddlePoint& j, const SolverChoice& choice,
               int max_iterations);

}  // namespace faultsim
