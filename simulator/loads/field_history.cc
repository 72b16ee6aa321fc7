#include "simulator/loads/field_history.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsim {

Eigen::VectorXd at_time(const std::vector<double>& time, const Eigen::MatrixXd& table, double at) {
  FAULTSIM_DEMAND(!time.empty() && std::ssize(time) == table.cols(), time.size(), " reports");
  if (at <= time.front()) return table.col(0);
  if (at >= time.back()) return table.col(table.cols() - 1);
  const Eigen::Index i = std::upper_bound(time.begin(), time.end(), at) - time.begin();
  const double share = (at - time[i - 1]) / (time[i] - time[i - 1]);
  return table.col(i - 1) + share * (table.col(i) - table.col(i - 1));
}

}  // namespace faultsim
