#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "simulator/common/run_context.h"
#include "simulator/common/words.h"
#include "simulator/coupled/leading_block.h"
#include "simulator/coupled/schur.h"

namespace faultsim {

/// Which factors of J = L U the preconditioner takes: both (two leading solves per iteration, as
/// Ferronato et al., SIAM GS 2019) or the upper one (one leading solve).
enum class BlockForm { full, upper };
constexpr auto words(BlockForm) { return std::array{"full", "upper"}; }

struct SolverChoice {
  LeadingKind leading = LeadingKind::exact;
  SchurKind schur = SchurKind::lsc;
  BlockForm form = BlockForm::upper;
  FsaiOptions fsai = {};
  IluOptions ilu = {};
  int max_iterations = 500;  ///< of GMRES: a linear step that takes more is not solved.
};

/// Of the names on the command line: "fsai", "rac". Throws InputError with the names that are none.
SolverChoice solver_of(const std::string& leading, const std::string& schur);

/// Whether several ranks can share it: blocks of hypre's with what is local or a product with K.
bool runs_on_ranks(const SolverChoice& choice);
/// Throws InputError where it cannot on so many.
void require_runs_on_ranks(const SolverChoice& choice, int n_ranks);

struct CoupledReport {
  bool converged = false;
  /// |b − J x| / |b| after 0, 1, 2 … iterations, by the recurrence of GMRES, in scaled rows.
  std::vector<double> residuals;
  double seconds = 0;  ///< of the processor.
  /// Iterations to a relative residual; −1 = never reached.
  int iterations_to(double tolerance) const;
};

/// mean |diag K| / mean |column of C|: what rows and columns of multipliers are scaled by, Pa per
/// scaled multiplier.
double scale_of_multipliers(const SaddlePoint& j);

/// Solves J (u, λ) = (f, g) by right-preconditioned GMRES without restart, from zero; J is not put
/// together for it. With M ≈ K + E and S̃ ≈ S,
///
///   full:   λ = S̃⁻¹ (Cᵀ M⁻¹ r_u − r_λ),  u = M⁻¹ r_u − M⁻¹ (C − F) λ
///   upper:  λ = −S̃⁻¹ r_λ,                u = M⁻¹ (r_u − (C − F) λ).
///
/// SchurKind::rac replaces both by augmented.h's elimination with one leading solve.
///
/// On several ranks each gives and gets its own rows and multipliers, and all calls are collective.
///
/// Rows and columns of multipliers are scaled by scale_of_multipliers, so that residuals of both
/// kinds count alike whatever the units.
class CoupledSolver {
 public:
  /// Sets the preconditioner up; `j` is kept by reference. Throws InputError as
  /// require_runs_on_ranks().
  CoupledSolver(const SaddlePoint& j, const SolverChoice& choice);
  ~CoupledSolver();
  CoupledSolver(const CoupledSolver&) = delete;
  CoupledSolver& operator=(const CoupledSolver&) = delete;

  /// @param f  n_u, N.  @param g  n_λ, m3: wanted Cᵀu = A g.
  /// @param stop  asked before each iteration: Interrupted, on all ranks where one is asked.
  CoupledReport solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance,
                      int max_iterations, Eigen::VectorXd& u, Eigen::VectorXd& lambda,
                      StopToken stop = {});
  /// Takes another linearisation on the same bulk, by the preconditioner that is there: only its
  /// springs follow, coarser levels stay. @pre runs_on_ranks(); `j` is kept by reference.
  void relinearise(const SaddlePoint& j);
  /// |(f, g)| as residuals are measured. Collective.
  double norm(const Eigen::VectorXd& f, const Eigen::VectorXd& g) const;
  double setup_seconds() const;         ///< of the processor, for the preconditioner.
  double preconditioner_bytes() const;  ///< on the heap, kept by the preconditioner.
  /// The number that scales multipliers, Pa per scaled one.
  double multiplier_scale() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faultsim
