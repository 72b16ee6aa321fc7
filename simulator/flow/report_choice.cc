#include "simulator/flow/report_choice.h"

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Whether all reports between two are within the bound of the line through them.
bool line_serves(const std::vector<double>& time, const Eigen::MatrixXd& value, int from, int to,
                 double bound) {
  for (int i = from + 1; i < to; ++i) {
    const double share = (time[i] - time[from]) / (time[to] - time[from]);
    const auto line = value.col(from) + share * (value.col(to) - value.col(from));
    if ((value.col(i) - line).cwiseAbs().maxCoeff() > bound) return false;
  }
  return true;
}

}  // namespace

std::vector<int> needed_reports(const std::vector<double>& time, const Eigen::MatrixXd& value,
                                double bound) {
  FAULTSIM_DEMAND(std::ssize(time) == value.cols() && value.rows() > 0 && bound >= 0, value.cols(),
                  " reports at ", time.size(), " times, bound ", bound);
  const int last = static_cast<int>(value.cols()) - 1;
  std::vector<int> needed{0};
  for (int from = 0; from < last; from = needed.back()) {
    int to = last;
    while (to > from + 1 && !line_serves(time, value, from, to, bound)) --to;
    needed.push_back(to);
  }
  return needed;
}

}  // namespace faultsim
