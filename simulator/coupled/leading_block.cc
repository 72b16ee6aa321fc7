#include "simulator/coupled/leading_block.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseLU>
#include <memory>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/coupled/hypre_blocks.h"
#include "simulator/linalg/cholesky.h"

namespace faultsim {
namespace {

using Eigen::VectorXd;

/// Three unknowns make a node, as nearly always here; what is left is a group of its own.
UnknownGroups groups_of_three(int n) {
  UnknownGroups groups{std::vector<int>(n), (n + 2) / 3};
  for (int i = 0; i < n; ++i) groups.of[i] = i / 3;
  return groups;
}

LinearMap fsai_block(const SparseMatrix& a, const FsaiOptions& options) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor, long> g = fsai_factor(a, options);
  return [g](const VectorXd& r, VectorXd& z) { z = g.transpose() * (g * r); };
}

LinearMap incomplete_cholesky(const Eigen::SparseMatrix<double>& a) {
  using Factor = Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  const auto factor = std::make_shared<Factor>(a);
  if (factor->info() != Eigen::Success)
    throw ResourceError("incomplete Cholesky: K + E is not positive definite");
  return [factor](const VectorXd& r, VectorXd& z) { z = factor->solve(r); };
}

}  // namespace

LinearMap direct_solver(const SparseMatrix& a, bool symmetric) {
  const int n = static_cast<int>(a.rows());
  if (symmetric) {
    SparseMatrix lower = a.triangularView<Eigen::Lower>();
    lower.makeCompressed();
    const auto factor = std::make_shared<TrailingCholesky>(lower, 0, groups_of_three(n));
    if (factor->failed_column() < 0)
      return [factor](const VectorXd& r, VectorXd& z) { z = factor->solve(r); };
  }
  const auto lu = std::make_shared<Eigen::SparseLU<Eigen::SparseMatrix<double>>>();
  const Eigen::SparseMatrix<double> copy = a;
  lu->compute(copy);
  if (lu->info() != Eigen::Success)
    throw ResourceError(concat("a matrix of ", n, " rows is singular"));
  return [lu](const VectorXd& r, VectorXd& z) { z = lu->solve(r); };
}

LinearMap leading_block(LeadingKind kind, std::shared_ptr<HypreMatrix> a, const SaddlePoint& of,
                        const IluOptions& ilu) {
  if (kind == LeadingKind::ilu) return hypre_ilu(std::move(a), ilu);
  if (kind == LeadingKind::amg) return hypre_amg(std::move(a), of.motions());
  FAULTSIM_DEMAND(kind == LeadingKind::amg_by_component, to_string(kind), " is not hypre's");
  return hypre_amg_by_component(std::move(a), of.motions());
}

LinearMap leading_block(LeadingKind kind, SaddlePoint j, const FsaiOptions& fsai,
                        const IluOptions& ilu) {
  if (kind == LeadingKind::exact) return direct_solver(j.leading(), j.symmetric);
  const std::shared_ptr<const SparseMatrix> a = j.symmetric_leading();
  if (kind == LeadingKind::fsai) return fsai_block(*a, fsai);
  if (kind == LeadingKind::incomplete_cholesky) return incomplete_cholesky(*a);
  return leading_block(kind, hypre_matrix(*a), j, ilu);
}

}  // namespace faultsim
