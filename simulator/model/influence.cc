#include "simulator/model/influence.h"

#include <algorithm>
#include <thread>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Eigen::Index;
constexpr Index kMostRows = 8192;  ///< of a tile: its sums stay in the second cache.
constexpr Index kFields = 8;       ///< that meet P while it is there.
constexpr Index kCells = 4;        ///< per visit of a sum.

/// sums += P's four columns from `p` on, times `s`. One cell after the other, so that a sum has the
/// same bits however the work is cut.
void add_four(const double* p, Index stride, const double* s, Index n_rows, double* sums) {
  const double *p1 = p + stride, *p2 = p1 + stride, *p3 = p2 + stride;
  for (Index i = 0; i < n_rows; ++i)
    sums[i] = sums[i] + s[0] * p[i] + s[1] * p1[i] + s[2] * p2[i] + s[3] * p3[i];
}

void add_one(const double* p, double s, Index n_rows, double* sums) {
  for (Index i = 0; i < n_rows; ++i) sums[i] += s * p[i];
}

/// All of P's columns on the rows [row, row + n_rows), times kFields fields from `field` on.
void add_tile(const Eigen::Map<const Eigen::MatrixXd>& p,
              const Eigen::Ref<const Eigen::MatrixXd>& s, Index row, Index n_rows, Index field,
              Eigen::MatrixXd& sums) {
  const Index last = std::min(field + kFields, s.cols());
  Index c = 0;
  for (; c + kCells <= p.cols(); c += kCells) {
    for (Index f = field; f < last; ++f)
      add_four(&p.coeffRef(row, c), p.rows(), &s.coeffRef(c, f), n_rows, &sums(row, f));
  }
  for (; c < p.cols(); ++c) {
    for (Index f = field; f < last; ++f)
      add_one(&p.coeffRef(row, c), s(c, f), n_rows, &sums(row, f));
  }
}

}  // namespace

Eigen::MatrixXd locked_change(const InfluenceBlock& block,
                              const Eigen::Ref<const Eigen::MatrixXd>& stress, int n_threads) {
  const auto p = block.traction.view();
  FAULTSIM_DEMAND(stress.rows() == p.cols(), stress.rows(), " values for ", p.cols(), " cells");
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(p.rows(), stress.cols());
  // Long runs of a column, so that memory is read as fast as it can be: a tile for each thread.
  const Index share = (p.rows() + n_threads - 1) / n_threads;
  const Index n_rows = std::clamp(share, Index{1}, kMostRows);
  const auto work = [&](Index thread) {
    for (Index field = 0; field < stress.cols(); field += kFields) {
      for (Index row = thread * n_rows; row < p.rows(); row += n_threads * n_rows)
        add_tile(p, stress, row, std::min(n_rows, p.rows() - row), field, sums);
    }
  };
  std::vector<std::jthread> others;
  for (Index thread = 1; thread < n_threads; ++thread) others.emplace_back(work, thread);
  work(0);
  others.clear();
  return sums;
}

}  // namespace faultsim
