#include "simulator/coupled/leading_block.h"

#include <Eigen/IterativeLinearSolvers>

#include "simulator/common/errors.h"
#include "simulator/coupled/hypre_blocks.h"

namespace faultsim {
namespace {

class ExactBlock final : public LeadingBlock {
 public:
  explicit ExactBlock(const SaddlePoint& j) : solver_(j.leading, j.symmetric) {}
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override { z = solver_.solve(r); }

 private:
  DirectSolver solver_;
};

class FsaiBlock final : public LeadingBlock {
 public:
  FsaiBlock(const SparseMatrix& a, const FsaiOptions& options) : factor_(fsai_factor(a, options)) {}
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    middle_ = factor_ * r;
    z = factor_.transpose() * middle_;
  }

 private:
  Eigen::SparseMatrix<double, Eigen::RowMajor, long> factor_;  ///< G
  Eigen::VectorXd middle_;
};

class IncompleteCholeskyBlock final : public LeadingBlock {
 public:
  explicit IncompleteCholeskyBlock(const SaddlePoint& j) {
    const Eigen::SparseMatrix<double> a = j.symmetric_leading();
    factor_.compute(a);
    if (factor_.info() != Eigen::Success) {
      throw ResourceError("incomplete Cholesky: K + E is not positive definite");
    }
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override { z = factor_.solve(r); }

 private:
  Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>> factor_;
};

}  // namespace

std::unique_ptr<LeadingBlock> make_leading_block(LeadingKind kind, const SaddlePoint& j,
                                                 const FsaiOptions& fsai, const IluOptions& ilu) {
  switch (kind) {
    case LeadingKind::exact:
      return std::make_unique<ExactBlock>(j);
    case LeadingKind::fsai:
      return std::make_unique<FsaiBlock>(j.symmetric_leading(), fsai);
    case LeadingKind::incomplete_cholesky:
      return std::make_unique<IncompleteCholeskyBlock>(j);
    case LeadingKind::ilu:
      return make_hypre_ilu(j.symmetric_leading(), ilu);
    case LeadingKind::amg:
      return make_hypre_amg(j.symmetric_leading(), j.rigid_motions);
    case LeadingKind::amg_by_component:
      return make_hypre_amg_by_component(j.symmetric_leading());
  }
  FAULTSIM_DEMAND(false, "leading block ", static_cast<int>(kind));
}

}  // namespace faultsim
