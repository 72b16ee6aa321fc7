#include "simulator/loads/field_history.h"

#include <algorithm>

#include "simulator/common/errors.h"

namespace faultsim {

Eigen::VectorXd at_time(const FieldHistory& history, const Eigen::MatrixXd& table, double time) {
  const std::vector<double>& t = history.time;
  FAULTSIM_DEMAND(!t.empty() && std::ssize(t) == table.cols(), t.size(), " reports");
  if (time <= t.front()) return table.col(0);
  if (time >= t.back()) return table.col(table.cols() - 1);
  const Eigen::Index i = std::upper_bound(t.begin(), t.end(), time) - t.begin();
  const double share = (time - t[i - 1]) / (t[i] - t[i - 1]);
  return table.col(i - 1) + share * (table.col(i) - table.col(i - 1));
}

}  // namespace faultsim
