#include "simulator/contact/bordered_lu.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace faultsim {
namespace {

std::size_t packed(int i) {
  return static_cast<std::size_t>(i) * (static_cast<std::size_t>(i) + 1) / 2;
}

using Slice = Eigen::Map<const Eigen::Array2d>;

/// sums[r] = rows[r]·x over n entries for four rows at once, so that the additions of one row need
/// not wait for each other.
void four_dots(const std::array<const double*, 4>& rows, const double* x, int n,
               std::array<double, 4>& sums) {
  Eigen::Array2d s0 = Eigen::Array2d::Zero(), s1 = s0, s2 = s0, s3 = s0;
  int i = 0;
  for (; i + 2 <= n; i += 2) {
    const Eigen::Array2d v = Slice(x + i);
    s0 += Slice(rows[0] + i) * v;
    s1 += Slice(rows[1] + i) * v;
    s2 += Slice(rows[2] + i) * v;
    s3 += Slice(rows[3] + i) * v;
  }
  sums = {s0.sum(), s1.sum(), s2.sum(), s3.sum()};
  if (i < n) {
    for (std::size_t r = 0; r < 4; ++r) sums[r] += rows[r][i] * x[i];
  }
}

/// x := T⁻¹ x for the lower triangle T packed by rows, with a unit diagonal or the stored one.
template <bool unit>
void solve_packed(const double* triangle, double* x, int n) {
  std::array<const double*, 4> rows;
  std::array<double, 4> sums;
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    for (int r = 0; r < 4; ++r) rows[r] = triangle + packed(i + r);
    four_dots(rows, x, i, sums);
    for (int r = 0; r < 4; ++r) {
      const double* row = rows[r];
      double value = x[i + r] - sums[r];
      for (int c = 0; c < r; ++c) value -= row[i + c] * x[i + c];
      x[i + r] = unit ? value : value / row[i + r];
    }
  }
  for (; i < n; ++i) {
    const double* row = triangle + packed(i);
    const double value = x[i] - Eigen::Map<const Eigen::VectorXd>(row, i).dot(
                                    Eigen::Map<const Eigen::VectorXd>(x, i));
    x[i] = unit ? value : value / row[i];
  }
}

/// x := U⁻¹ x for the upper triangle packed by columns, two columns at a time.
void solve_upper(const double* triangle, double* x, int n) {
  int j = n - 1;
  for (; j >= 1; j -= 2) {
    const double* last = triangle + packed(j);
    const double* first = triangle + packed(j - 1);
    x[j] /= last[j];
    x[j - 1] = (x[j - 1] - last[j - 1] * x[j]) / first[j - 1];
    Eigen::Map<Eigen::VectorXd>(x, j - 1) -=
        x[j] * Eigen::Map<const Eigen::VectorXd>(last, j - 1) +
        x[j - 1] * Eigen::Map<const Eigen::VectorXd>(first, j - 1);
  }
  if (j == 0) x[0] /= triangle[0];
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
  solve_packed<true>(lower_.data(), u, size_);
  solve_packed<false>(upper_.data(), l, size_);
  const double pivot = diagonal - Eigen::Map<const Eigen::VectorXd>(l, size_).dot(
                                      Eigen::Map<const Eigen::VectorXd>(u, size_));
  if (pivot == 0 || !std::isfinite(pivot)) return pivot;
  u[size_++] = pivot;
  return pivot;
}

void BorderedLu::solve(double* x) const {
  solve_packed<true>(lower_.data(), x, size_);
  solve_upper(upper_.data(), x, size_);
}

}  // namespace faultsim
