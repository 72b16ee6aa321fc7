#include "simulator/linalg/sparse_forward.h"

#include <cblas.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace faultsim {
namespace {

/// Goes up the elimination tree with a block of loads. Values lie by place, the block's loads
/// beside each other; between blocks all are zero.
class SparseForward {
 public:
  SparseForward(const Supernodes& factor, long n_bulk)
      : l_(factor),
        n_bulk_(n_bulk),
        supernode_(factor.n),
        values_(Eigen::MatrixXd::Zero(kForwardWidth, factor.n)),
        on_path_(factor.count) {
    for (long s = 0; s < l_.count; ++s) {
      std::fill(&supernode_[l_.begin[s]], &supernode_[0] + l_.begin[s + 1], s);
    }
  }

  void add(int column, long place, double value) {
    values_(column, place) += value;
    // What is marked has its ancestors marked already.
    for (long s = supernode_[place]; is_bulk(s) && !on_path_[s]; s = parent(s)) {
      on_path_[s] = 1;
      path_.push_back(s);
    }
  }

  void substitute() {
    std::ranges::sort(path_);
    for (const long s : path_) {
      eliminate(s);
      on_path_[s] = 0;
    }
    path_.clear();
  }

  /// What the substitution left at the trailing places, taken away.
  void take(int column, double* tail) {
    for (long i = n_bulk_; i < l_.n; ++i) {
      *tail++ = values_(column, i);
      values_(column, i) = 0;
    }
  }

 private:
  bool is_bulk(long s) const { return s < l_.count && l_.begin[s] < n_bulk_; }
  long parent(long s) const {
    const long below = l_.row_begin[s] + l_.begin[s + 1] - l_.begin[s];
    return below < l_.row_begin[s + 1] ? supernode_[l_.rows[below]] : l_.count;
  }

  /// x_s ← L_ss⁻¹ x_s, then x_below −= L_below,s x_s; x_s is no longer wanted.
  void eliminate(long s) {
    const long first = l_.begin[s];
    const int k = static_cast<int>(std::min(l_.begin[s + 1], n_bulk_) - first);
    const int n_rows = static_cast<int>(l_.row_begin[s + 1] - l_.row_begin[s]);
    const double* block = l_.values + l_.value_begin[s];
    double* x = values_.col(first).data();
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, kForwardWidth, k,
                1.0, block, n_rows, x, kForwardWidth);
    const int n_below = n_rows - k;
    if (n_below > 0) {
      if (update_.cols() < n_below) update_.resize(kForwardWidth, n_below);
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, kForwardWidth, n_below, k, 1.0, x,
                  kForwardWidth, block + k, n_rows, 0.0, update_.data(), kForwardWidth);
      const long* row = l_.rows + l_.row_begin[s] + k;
      for (int i = 0; i < n_below; ++i) values_.col(row[i]) -= update_.col(i);
    }
    values_.middleCols(first, k).setZero();
  }

  const Supernodes& l_;
  long n_bulk_;
  std::vector<long> supernode_;  // of a place
  Eigen::Matrix<double, kForwardWidth, Eigen::Dynamic> values_, update_;
  std::vector<char> on_path_;
  std::vector<long> path_;
};

}  // namespace

Eigen::MatrixXd condense_sparse(const Supernodes& factor, const std::vector<long>& place,
                                long n_bulk, const std::vector<SparseLoad>& loads,
                                const std::function<void(double)>& progress) {
  // The order of elimination follows the tree: loads that start close share most of their way.
  std::vector<long> start(loads.size(), std::numeric_limits<long>::max());
  for (std::size_t k = 0; k < loads.size(); ++k) {
    for (const auto& [unknown, value] : loads[k]) start[k] = std::min(start[k], place[unknown]);
  }
  std::vector<int> order(loads.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) { return start[a] < start[b]; });

  const auto n = static_cast<int>(loads.size());
  Eigen::MatrixXd condensed(factor.n - n_bulk, n);
  SparseForward forward(factor, n_bulk);
  for (int from = 0; from < n; from += kForwardWidth) {
    const int width = std::min(kForwardWidth, n - from);
    for (int j = 0; j < width; ++j) {
      for (const auto& [unknown, value] : loads[order[from + j]]) {
        forward.add(j, place[unknown], value);
      }
    }
    forward.substitute();
    for (int j = 0; j < width; ++j) forward.take(j, condensed.col(order[from + j]).data());
    progress(1.0 * (from + width) / n);
  }
  return condensed;
}

}  // namespace faultsim
