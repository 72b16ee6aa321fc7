#include "simulator/model/compliance.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/thread_team.h"
#include "simulator/linalg/column_sum.h"

namespace faultsim {

DenseCompliance::DenseCompliance(StoredMatrix h) : h_(std::move(h)) {
  FAULTSIM_DEMAND(matrix().rows() == matrix().cols(), "H is ", matrix().rows(), " x ",
                  matrix().cols());
}

namespace {

/// Of the rows the share i of n, as nearly equal as can be.
std::vector<RowRange> share_of(std::span<const RowRange> rows, int i, int n) {
  std::int64_t n_rows = 0;
  for (const RowRange& range : rows) n_rows += range.n;
  const std::int64_t first = n_rows * i / n, last = n_rows * (i + 1) / n;
  std::vector<RowRange> share;
  std::int64_t at = 0;  // rows before the range
  for (const RowRange& range : rows) {
    const auto from = static_cast<int>(std::clamp<std::int64_t>(first - at, 0, range.n));
    const auto to = static_cast<int>(std::clamp<std::int64_t>(last - at, 0, range.n));
    if (from < to) share.push_back({range.first + from, to - from});
    at += range.n;
  }
  return share;
}

/// Into how many shares rows are cut.
int n_shares(std::span<const RowRange> rows, std::size_t n_columns, const ThreadTeam* team) {
  constexpr double kWorth = 1e6;  // bytes that are read in the time that it takes to wake a thread
  constexpr int kPerThread = 4;   // as some may come late
  double n_rows = 0;
  for (const RowRange& range : rows) n_rows += range.n;
  const double bytes = sizeof(double) * static_cast<double>(n_columns) * n_rows;
  return team == nullptr || team->n_threads() < 2 || bytes < kWorth
             ? 1
             : kPerThread * team->n_threads();
}

}  // namespace

void Compliance::subtract_product(std::span<const int> active, const Eigen::VectorXd& jump,
                                  const Eigen::VectorXd& inverse_area,
                                  std::span<const RowRange> rows, Eigen::VectorXd& traction,
                                  ThreadTeam* team) const {
  const auto columns = mapped(active, [this](int j) { return column(j).data(); });
  const auto factors = mapped(active, [&](int j) { return jump[j]; });
  const int n = n_shares(rows, columns.size(), team);
  for_each(team, n, [&](int i) {
    Eigen::VectorXd product;
    for (const RowRange& part : share_of(rows, i, n)) {
      product.setZero(part.n);
      add_columns(columns, factors, static_cast<std::size_t>(part.first),
                  {product.data(), static_cast<std::size_t>(part.n)});
      traction.segment(part.first, part.n).array() -=
          product.array() * inverse_area.segment(part.first, part.n).array();
    }
  });
}

}  // namespace faultsim
