#include "simulator/linalg/dense_cholesky.h"

#include <utility>

#include "simulator/common/errors.h"
#include "simulator/linalg/lapack.h"

namespace faultsim {

bool DenseCholesky::factor(Eigen::MatrixXd matrix) {
  const int n = static_cast<int>(matrix.rows());
  factor_ = std::move(matrix);
  if (n == 0) return true;
  int info = 0;
  dpotrf_("L", &n, factor_.data(), &n, &info, 1);
  FAULTSIM_DEMAND(info >= 0, "argument ", -info, " of dpotrf");
  if (info > 0) factor_.resize(0, 0);
  return info == 0;
}

Eigen::VectorXd DenseCholesky::solve(Eigen::VectorXd x) const {
  const int n = static_cast<int>(factor_.rows()), one = 1;
  FAULTSIM_DEMAND(x.size() == n, x.size(), " for ", n);
  if (n == 0) return x;
  int info = 0;
  dpotrs_("L", &n, &one, factor_.data(), &n, x.data(), &n, &info, 1);
  FAULTSIM_DEMAND(info == 0, "argument ", -info, " of dpotrs");
  return x;
}

}  // namespace faultsim
