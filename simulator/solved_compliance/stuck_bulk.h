#pragma once

#include <memory>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/run_context.h"
#include "simulator/coupled/coupled_solver.h"
#include "simulator/elasticity/bulk_problem.h"
#include "simulator/linalg/conjugate_gradients.h"

namespace faultsim {

/// A linear system of the bulk that was not solved to its tolerance.
class Unsolved : public ResourceError {
  using ResourceError::ResourceError;
};

/// The linear bulk with every jump held, as a solver: K of (r, g) ((7) of docs/model.md) in its
/// blocks, and r = K_rr⁻¹ f_r by conjugate gradients. K_rr is the stiffness of the body without its
/// faults: symmetric positive definite wherever the body is held, whatever faults cut loose, and
/// there are no multipliers, so algebraic multigrid does what it was made for. No factor with the
/// jumps last, and no H, are made.
class StuckBulk {
 public:
  /// How exact solves are unless asked otherwise, relative: see conjugate_gradients().
  static constexpr double kTolerance = 1e-11;

  /// @param solver  `leading` preconditions K_rr, `exact` factorises it; `schur` and `form` are not
  ///                looked at.
  /// Throws InputError when a body can move as one, and for a preconditioner that is not symmetric
  /// (ilu); ResourceError when memory is short.
  StuckBulk(std::shared_ptr<const BulkProblem> problem, const SolverChoice& solver,
            double tolerance = kTolerance);
  ~StuckBulk();
  StuckBulk(const StuckBulk&) = delete;
  StuckBulk& operator=(const StuckBulk&) = delete;

  const BulkProblem& problem() const;
  const DofMap& dofs() const;
  /// K (0, g): the forces on all unknowns when the jumps are g and nothing else moves, N.
  Eigen::VectorXd jump_forces(const Eigen::VectorXd& g) const;
  /// Diagonal of K_gg, N/m: H_jj ≤ K_jj, as H is K_gg less a semidefinite matrix.
  const Eigen::VectorXd& jump_diagonal() const;

  /// What forces do while the jumps are held. For one thread at a time.
  struct Response {
    Eigen::VectorXd r;      ///< K_rr⁻¹ f_r, n_bulk, m.
    Eigen::VectorXd jumps;  ///< f_g − K_gr r, n_jump, N. Entry i is off by at most
                            ///< √K_ii · report.energy_error (Cauchy and Schwarz in K_rr).
    CgReport report;        ///< converged.
  };
  /// @param force  f over all unknowns (r, g), N. Throws Unsolved where the tolerance is not
  /// reached within the solver's iterations. Same force, same bits.
  Response respond(const Eigen::VectorXd& force) const;

  /// Who may stop respond(), in any iteration: Interrupted.
  void heed(StopToken stop) const;

  /// What has been done so far.
  struct Work {
    int n_solves = 0;
    std::vector<int> iterations;  ///< of each.
    double setup_seconds = 0;     ///< of the processor.
    double solve_seconds = 0;     ///< of the processor.
  };
  const Work& work() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
