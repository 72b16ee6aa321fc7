#include <Eigen/SparseLU>

#include "simulator/common/errors.h"
#include "simulator/coupled/leading_block.h"
#include "simulator/linalg/cholesky.h"

namespace faultsim {
namespace {

/// Three unknowns make a node, as nearly always here; what is left is a group of its own.
std::vector<int> groups_of_three(int n) {
  std::vector<int> group(n);
  for (int i = 0; i < n; ++i) group[i] = i / 3;
  return group;
}

}  // namespace

struct DirectSolver::Impl {
  std::unique_ptr<TrailingCholesky> cholesky;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu;
};

DirectSolver::DirectSolver(const SparseMatrix& a, bool symmetric)
    : impl_(std::make_unique<Impl>()) {
  const int n = static_cast<int>(a.rows());
  if (symmetric) {
    SparseMatrix lower = a.triangularView<Eigen::Lower>();
    lower.makeCompressed();
    impl_->cholesky = std::make_unique<TrailingCholesky>(lower, 0, groups_of_three(n), (n + 2) / 3);
    if (impl_->cholesky->failed_column() < 0) return;
    impl_->cholesky.reset();
  }
  const Eigen::SparseMatrix<double> copy = a;
  impl_->lu.compute(copy);
  if (impl_->lu.info() != Eigen::Success) {
    throw ResourceError(concat("a matrix of ", n, " rows is singular"));
  }
}

DirectSolver::~DirectSolver() = default;

Eigen::VectorXd DirectSolver::solve(const Eigen::VectorXd& r) {
  if (impl_->cholesky) return impl_->cholesky->solve(r);
  return impl_->lu.solve(r);
}

}  // namespace faultsim
