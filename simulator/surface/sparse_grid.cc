#include "simulator/surface/sparse_grid.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"

namespace faultsim {
namespace {

/// Where Π |x − x_i| is largest between two neighbouring points: its logarithm is concave there, so
/// bisection of the derivative finds it.
double peak_between(const std::vector<double>& points, double from, double to) {
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (from + to);
    double slope = 0;
    for (const double point : points) slope += 1 / (middle - point);
    (slope > 0 ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

double next_leja_point(const std::vector<double>& points) {
  std::vector<double> sorted = points;
  std::ranges::sort(sorted);
  double best = 0, largest = -1;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    const double x = peak_between(points, sorted[i], sorted[i + 1]);
    double product = 1;
    for (const double point : points) product *= std::abs(x - point);
    if (product > largest * (1 + 1e-9)) {  // mirror images differ by rounding only
      best = x;
      largest = product;
    }
  }
  return std::round(best * 1e12) / 1e12;
}

}  // namespace

double leja_point(int k) {
  static std::mutex mutex;
  static std::vector<double> points = {0, 1, -1};
  const std::lock_guard lock(mutex);
  while (static_cast<int>(points.size()) <= k) points.push_back(next_leja_point(points));
  return points[k];
}

SparseGrid::SparseGrid(int n_axes)
    : indices_{Index(static_cast<std::size_t>(n_axes), 0)},
      newton_at_nodes_(Eigen::MatrixXd::Ones(1, 1)) {
  FAULTSIM_DEMAND(n_axes > 0, n_axes, " axes");
}

Eigen::VectorXd SparseGrid::place(const Index& index) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(index.size()));
  for (std::size_t j = 0; j < index.size(); ++j) x[j] = leja_point(index[j]);
  return x;
}

bool SparseGrid::admits(const Index& index) const {
  const auto known = [&](const Index& one) { return contains(indices_, one); };
  if (index.size() != indices_.front().size() || known(index)) return false;
  for (std::size_t j = 0; j < index.size(); ++j) {
    if (index[j] < 0) return false;
    Index before = index;
    if (--before[j] >= 0 && !known(before)) return false;
  }
  return true;
}

std::vector<SparseGrid::Index> SparseGrid::successors(const Index& index) const {
  std::vector<Index> found;
  for (std::size_t j = 0; j < index.size(); ++j) {
    Index next = index;
    ++next[j];
    if (admits(next)) found.push_back(next);
  }
  return found;
}

int SparseGrid::add(const Index& index) {
  FAULTSIM_DEMAND(admits(index), "an index that does not follow from those there");
  indices_.push_back(index);
  const Eigen::Index n = n_nodes();
  newton_at_nodes_.conservativeResize(n, n);
  newton_at_nodes_.col(n - 1).setZero();
  newton_at_nodes_.row(n - 1) = newton(place(index)).transpose();
  newton_at_nodes_(n - 1, n - 1) = 1;
  return static_cast<int>(n) - 1;
}

Eigen::VectorXd SparseGrid::newton(const Eigen::VectorXd& x) const {
  FAULTSIM_DEMAND(x.size() == n_axes(), x.size(), " coordinates");
  std::vector<std::vector<double>> along(static_cast<std::size_t>(n_axes()), {1.0});
  for (std::size_t j = 0; j < along.size(); ++j) {
    int most = 0;
    for (const Index& index : indices_) most = std::max(most, index[j]);
    for (int k = 1; k <= most; ++k) {
      double value = 1;
      for (int i = 0; i < k; ++i) value *= (x[j] - leja_point(i)) / (leja_point(k) - leja_point(i));
      along[j].push_back(value);
    }
  }
  Eigen::VectorXd values(n_nodes());
  for (int k = 0; k < n_nodes(); ++k) {
    double value = 1;
    for (std::size_t j = 0; j < along.size(); ++j) value *= along[j][indices_[k][j]];
    values[k] = value;
  }
  return values;
}

Eigen::VectorXd SparseGrid::weights(const Eigen::VectorXd& x) const {
  return newton_at_nodes_.triangularView<Eigen::UnitLower>().transpose().solve(newton(x));
}

}  // namespace faultsim
