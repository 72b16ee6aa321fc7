#pragma once

#include <string>
#include <vector>

#include "simulator/model/frictional_contact.h"

namespace faultsim {

/// A solver of Siconos as we use it.
struct SiconosSolver {
  std::string name;
  int id = 0;                 ///< SICONOS_FRICTION_...
  int local_id = 0;           ///< solver of one contact; 0 = Siconos' choice.
  bool sparse_block = false;  ///< W as d x d blocks instead of dense.
  bool freezes = false;       ///< contacts at rest are visited every tenth sweep only.
};

/// The solvers of Siconos that suit a dense W in this dimension.
std::vector<SiconosSolver> siconos_solvers(int dimension);

struct SiconosRun {
  bool claims = false;  ///< Siconos says that it converged.
  int iterations = 0;
  double seconds = 0;  ///< of the call that solves; the least of the repetitions.
  Eigen::VectorXd r;
};

struct SiconosLimits {
  double accuracy =
      1e-10;  ///< of Siconos' own measure: the natural map over the norm of q, or of r.
  int max_iterations = 2000;
  int repetitions = 4;
  double long_run = 1;  ///< s; a run that takes longer is not repeated.
};

/// Solves a problem by a solver of Siconos from the reactions `start`. Setting up W in Siconos'
/// form is not in the time.
SiconosRun run_siconos(const SiconosSolver& solver, const FrictionalContactProblem& problem,
                       const Eigen::VectorXd& start, const SiconosLimits& limits);

}  // namespace faultsim
