#pragma once

#include <Eigen/Core>
#include <memory>

#include "simulator/coupled/coupled_solver.h"

namespace faultsim {

/// The linear systems of Newton's method, one after the other, by a preconditioner that is kept for
/// as long as that is cheaper: what a new one would have saved, in iterations since the last, must
/// first have added up to what setting it up costs. Counted, not timed: same input, same bits.
class LinearSteps {
 public:
  /// @param stop  as CoupledSolver::solve() asks it.
  explicit LinearSteps(const SolverChoice& choice, StopToken stop = {})
      : choice_(choice), stop_(stop) {}

  struct Solved {
    CoupledReport report;
    double setup_seconds = 0;  ///< of the processor; 0 where the preconditioner was kept.
    double tolerance = 0;      ///< of the residual, relative to the right-hand side.
  };
  /// Solves J (u, λ) = (f, g) as CoupledSolver. Collective.
  /// @param tolerance  a function of the norm of the right-hand side.
  template <typename Tolerance>
  Solved solve(SaddlePoint j, const Eigen::VectorXd& f, const Eigen::VectorXd& g,
               const Tolerance& tolerance, Eigen::VectorXd& u, Eigen::VectorXd& lambda) {
    Solved solved;
    take(std::move(j), solved);
    solved.tolerance = tolerance(solver_->norm(f, g));
    solve_to(f, g, u, lambda, solved);
    return solved;
  }

 private:
  void take(SaddlePoint j, Solved& solved);
  void set_up(Solved& solved);
  void solve_to(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u,
                Eigen::VectorXd& lambda, Solved& solved);

  SolverChoice choice_;
  StopToken stop_;
  std::unique_ptr<SaddlePoint> j_;
  std::unique_ptr<CoupledSolver> solver_;  ///< none: to be set up.
  bool is_new_ = false;
  double per_decade_ = 0;  ///< iterations, when it was new; 0: not known.
  double lost_ = 0;        ///< iterations since then, against as many per decade.
};

/// How far a linear step is solved: as far as Newton's method gains by it (Eisenstat and Walker,
/// SIAM J. Sci. Comput. 17, 1996, choice 2: 0.9 (|r|/|r of the step before|)²), and no further than
/// the load step asks for: where that is reached by another decade, by that. Their safeguard begins
/// at 0.1, above any `loosest` taken here.
class ForcingTerm {
 public:
  /// @param loosest  the first, and the largest of what is not the last. @param asked  of the load
  /// step's first residual.
  /// @param first  that residual where Newton starts from a better place; 0: the first that comes.
  ForcingTerm(double loosest, double asked, double first = 0)
      : loosest_(loosest), asked_(asked), first_(first) {}
  /// @param norm  of the residual that the next linear step starts from.
  double next(double norm);

 private:
  double loosest_, asked_;
  double first_, before_ = 0;  ///< residuals.
};

}  // namespace faultsim
