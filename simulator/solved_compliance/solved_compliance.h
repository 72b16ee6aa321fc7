#pragma once

#include <memory>
#include <vector>

#include "simulator/model/compliance.h"
#include "simulator/solved_compliance/stuck_bulk.h"

namespace faultsim {

/// H that is solved for instead of stored (docs/model.md, section 11): a column is one solve with
/// the stiffness of the body without its faults,
///
///   H e_j = K_gg e_j − K_gr K_rr⁻¹ K_rg e_j,      N/m,
///
/// made when it is first asked for and kept. Contact asks for columns of dofs that move or may
/// begin to; those of nodes that stay stuck are never made.
///
/// Accuracy: with e_j the error of the solve in the energy norm of K_rr, known to be at most
/// E_j = ε |K_rr⁻¹ K_rg e_j| (conjugate_gradients.h; ε = StuckBulk::kTolerance),
///
///   |δH_ij| ≤ √(K_ii − H_ii) E_j ≤ ε √(K_ii K_jj) to a factor near one,
///
/// so that tractions are off by |δt'_i| ≤ √K_ii / A_i Σ_j E_j |Δg_j|. A column is the same bits
/// whenever and in whatever order it is made, so contact solves one problem, whose H is symmetric
/// to that accuracy; how far it is from the exact one is measured by product(), a single solve.
class SolvedCompliance final : public Compliance {
 public:
  /// @param memory_limit  bytes that columns may take together.
  SolvedCompliance(std::shared_ptr<const StuckBulk> bulk, double memory_limit);

  int size() const override { return static_cast<int>(bulk_->jump_diagonal().size()); }
  /// Valid until begin_step(). Throws Unsolved, or ResourceError where the columns asked for since
  /// begin_step() take more than the limit.
  Column column(int j) const override;
  double diagonal(int j) const override { return column(j)[j]; }
  /// K_jj.
  double diagonal_bound(int j) const override { return bulk_->jump_diagonal()[j]; }
  bool is_solved_for() const override { return true; }

  /// Columns asked for so far may be forgotten, those first that have waited longest, when others
  /// need their room. Whoever holds one must ask for it again.
  void begin_step() { ++step_; }
  /// H g by one solve, N, whose entry i is off by at most √K_ii · energy_error.
  struct Product {
    Eigen::VectorXd forces;
    double energy_error;
  };
  Product product(const Eigen::VectorXd& g) const;

  int n_kept() const { return n_kept_; }  ///< columns in memory.
  int n_made() const { return n_made_; }  ///< columns solved for, again those that were forgotten.
  double bytes() const { return bytes_per_column() * n_kept_; }
  /// Largest E_j / √K_jj of all columns made: |δH_ij| ≤ this · √(K_ii K_jj).
  double error_bound() const { return error_bound_; }

 private:
  struct Kept {
    Eigen::VectorXd values;  ///< empty: not there.
    long step = -1;          ///< in which it was last asked for.
    long turn = -1;          ///< and when.
  };
  double bytes_per_column() const { return 8.0 * size(); }
  void make_room() const;

  std::shared_ptr<const StuckBulk> bulk_;
  double memory_limit_;
  long step_ = 0;
  mutable std::vector<Kept> columns_;
  mutable long turn_ = 0;
  mutable int n_kept_ = 0, n_made_ = 0;
  mutable double error_bound_ = 0;
};

}  // namespace faultsim
