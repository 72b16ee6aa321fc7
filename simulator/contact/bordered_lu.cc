#include "simulator/contact/bordered_lu.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

std::size_t packed(int i) {
  return static_cast<std::size_t>(i) * (static_cast<std::size_t>(i) + 1) / 2;
}

double dot(const double* a, const double* b, int n) {
  return Eigen::Map<const Eigen::VectorXd>(a, n).dot(Eigen::Map<const Eigen::VectorXd>(b, n));
}

}  // namespace

void BorderedLu::reserve() {
  const std::size_t needed = packed(size_ + 1);
  if (lower_.size() >= needed) return;
  const std::size_t grown = std::max(needed, 2 * lower_.size());
  lower_.resize(grown);
  upper_.resize(grown);
}

double* BorderedLu::row() {
  reserve();
  return lower_.data() + packed(size_);
}

double* BorderedLu::column() {
  reserve();
  return upper_.data() + packed(size_);
}

double BorderedLu::append(double diagonal) {
  double* l = row();
  double* u = column();
  for (int j = 0; j < size_; ++j) {
    const double* upper_column = upper_.data() + packed(j);
    u[j] -= dot(lower_.data() + packed(j), u, j);
    l[j] = (l[j] - dot(upper_column, l, j)) / upper_column[j];
  }
  const double pivot = diagonal - dot(l, u, size_);
  if (pivot == 0 || !std::isfinite(pivot)) return pivot;
  u[size_++] = pivot;
  return pivot;
}

void BorderedLu::solve(double* x) const {
  for (int i = 0; i < size_; ++i) x[i] -= dot(lower_.data() + packed(i), x, i);
  for (int j = size_ - 1; j >= 0; --j) {
    const double* column = upper_.data() + packed(j);
    x[j] /= column[j];
    Eigen::Map<Eigen::VectorXd>(x, j) -= x[j] * Eigen::Map<const Eigen::VectorXd>(column, j);
  }
}

}  // namespace faultsim
