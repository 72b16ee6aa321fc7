#include "simulator/linalg/dense_lu.h"

#include "simulator/common/errors.h"
#include "simulator/linalg/lapack.h"

namespace faultsim {

bool DenseLu::factor(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  FAULTSIM_DEMAND(matrix.rows() == matrix.cols(), matrix.rows(), " x ", matrix.cols());
  const int n = static_cast<int>(matrix.rows());
  clear();
  // Grows by doubling: sizes change often.
  if (factors_.rows() < n) {
    factors_.resize(0, 0);
    factors_.resize(2L * n, 2L * n);
  }
  factors_.topLeftCorner(n, n) = matrix;
  const int stride = static_cast<int>(factors_.rows());
  pivots_.resize(static_cast<std::size_t>(n));
  int info = 0;
  if (n > 0) dgetrf_(&n, &n, factors_.data(), &stride, pivots_.data(), &info);
  if (info != 0) clear();
  return info == 0;
}

void DenseLu::solve(Eigen::VectorXd& x) const {
  FAULTSIM_DEMAND(x.size() == size(), x.size(), " entries, matrix of size ", size());
  const int n = static_cast<int>(size());
  if (n == 0) return;
  const int stride = static_cast<int>(factors_.rows());
  const int one = 1;
  int info = 0;
  dgetrs_("N", &n, &one, factors_.data(), &stride, pivots_.data(), x.data(), &n, &info, 1);
  FAULTSIM_DEMAND(info == 0, "dgetrs ", info);
}

}  // namespace faultsim
