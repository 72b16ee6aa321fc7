#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/coupled/leading_block.h"

namespace faultsim {
namespace {

/// Grows the rows of G one after another; scratch is kept between them.
class FsaiRows {
 public:
  FsaiRows(const SparseMatrix& a, const FsaiOptions& options)
      : a_(a), options_(options), diagonal_(a.diagonal()), gradient_(a.rows()) {
    is_touched_.assign(a.rows(), 0);
  }

  /// Appends row i of G. With y = −A_PP⁻¹ a_Pi on the pattern P, the row is (y, 1)/√ψ_i and
  /// ψ_i = a_ii + a_iP y.
  void append(int i, std::vector<Eigen::Triplet<double, long>>& entries) {
    pattern_.clear();
    y_.resize(0);
    double psi = diagonal_[i];
    for (int step = 0; step < options_.steps && psi > options_.tolerance * diagonal_[i]; ++step) {
      differentiate(i);
      if (!extend()) break;
      psi = solve(i);
    }
    if (!(psi > 0)) throw ResourceError(concat("FSAI: row ", i, " of no positive definite matrix"));
    const double scale = 1 / std::sqrt(psi);
    for (int k = 0; k < static_cast<int>(pattern_.size()); ++k) {
      entries.emplace_back(i, pattern_[k], scale * y_[k]);
    }
    entries.emplace_back(i, i, scale);
  }

 private:
  /// gradient := A_·P y + a_·i over the columns below i that it touches.
  void differentiate(int i) {
    touched_.clear();
    add_column(i, 1, i);
    for (int k = 0; k < static_cast<int>(pattern_.size()); ++k) add_column(pattern_[k], y_[k], i);
  }

  void add_column(int column, double factor, int i) {
    for (SparseMatrix::InnerIterator it(a_, column); it && it.row() < i; ++it) {
      const int j = static_cast<int>(it.row());
      if (!is_touched_[j]) {
        is_touched_[j] = 1;
        touched_.push_back(j);
        gradient_[j] = 0;
      }
      gradient_[j] += factor * it.value();
    }
  }

  /// Adds to P the columns that would lower ψ most if each came alone, by gradient_j²/a_jj; of
  /// equal ones the first. @returns whether there were any.
  bool extend() {
    const auto gain = [&](int j) { return gradient_[j] * gradient_[j] / diagonal_[j]; };
    for (const int j : pattern_) is_touched_[j] = 2;
    std::vector<int>& candidates = candidates_;
    candidates.clear();
    for (const int j : touched_) {
      if (is_touched_[j] == 1 && gradient_[j] != 0) candidates.push_back(j);
      is_touched_[j] = 0;
    }
    for (const int j : pattern_) is_touched_[j] = 0;
    const int n = std::min(options_.step_size, static_cast<int>(candidates.size()));
    std::partial_sort(candidates.begin(), candidates.begin() + n, candidates.end(),
                      [&](int a, int b) { return gain(a) != gain(b) ? gain(a) > gain(b) : a < b; });
    pattern_.insert(pattern_.end(), candidates.begin(), candidates.begin() + n);
    std::ranges::sort(pattern_);
    return n > 0;
  }

  /// y on the pattern. @returns ψ_i.
  double solve(int i) {
    const int n = static_cast<int>(pattern_.size());
    block_.setZero(n, n);
    for (int k = 0; k < n; ++k) read_column(pattern_[k], block_.col(k));
    right_.setZero(n);
    read_column(i, right_);
    y_ = -block_.llt().solve(right_);
    return diagonal_[i] + right_.dot(y_);
  }

  /// The entries of a column of A in the rows of the pattern.
  void read_column(int column, Eigen::Ref<Eigen::VectorXd> values) const {
    int k = 0;
    const int n = static_cast<int>(pattern_.size());
    for (SparseMatrix::InnerIterator it(a_, column); it; ++it) {
      while (k < n && pattern_[k] < it.row()) ++k;
      if (k == n) return;
      if (pattern_[k] == it.row()) values[k] = it.value();
    }
  }

  const SparseMatrix& a_;
  const FsaiOptions& options_;
  Eigen::VectorXd diagonal_, gradient_;
  std::vector<char> is_touched_;  ///< 0 no, 1 yes, 2 in the pattern.
  std::vector<int> touched_, candidates_, pattern_;
  Eigen::MatrixXd block_;
  Eigen::VectorXd right_, y_;
};

}  // namespace

SparseMatrix fsai_factor(const SparseMatrix& a, const FsaiOptions& options) {
  const int n = static_cast<int>(a.rows());
  std::vector<Eigen::Triplet<double, long>> entries;
  entries.reserve(static_cast<long>(n) * (1 + options.steps * options.step_size));
  FsaiRows rows(a, options);
  for (int i = 0; i < n; ++i) {
    rows.append(i, entries);
  }
  SparseMatrix factor(n, n);
  factor.setFromTriplets(entries.begin(), entries.end());
  return factor;
}

}  // namespace faultsim
