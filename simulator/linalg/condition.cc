#include "simulator/linalg/condition.h"

#include <cstddef>
#include <limits>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/linalg/lapack.h"

namespace faultsim {

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
