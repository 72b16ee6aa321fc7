#include "simulator/linalg/dense_cholesky.h"

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

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

std::optional<double> spd_condition(Eigen::MatrixXd matrix) {
  FAULTSIM_DEMAND(matrix.rows() == matrix.cols(), matrix.rows(), " x ", matrix.cols());
  const int n = static_cast<int>(matrix.rows());
  if (n == 0) return 1;
  if (!matrix.allFinite()) return std::nullopt;
  std::vector<double> work(3 * static_cast<std::size_t>(n));
  std::vector<int> iwork(static_cast<std::size_t>(n));
  const double norm = dlansy_("1", "L", &n, matrix.data(), &n, work.data(), 1, 1);
  int info = 0;
  dpotrf_("L", &n, matrix.data(), &n, &info, 1);
  if (info != 0) return std::nullopt;
  double reciprocal = 0;
  dpocon_("L", &n, matrix.data(), &n, &norm, &reciprocal, work.data(), iwork.data(), &info, 1);
  FAULTSIM_DEMAND(info == 0, "dpocon ", info);
  return reciprocal > 0 ? 1 / reciprocal : std::numeric_limits<double>::infinity();
}

}  // namespace faultsim
