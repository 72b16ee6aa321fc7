#include "simulator/model/direction_blocks.h"

#include <algorithm>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/linalg/shared_bases.h"

namespace faultsim {
namespace {

/// Shorter runs: more of H far from the diagonal, and more bases to keep.
constexpr int kMostInRun = 192;

/// Entries of a pair of runs of n and m jumps in `far`.
Eigen::Index entries(Eigen::Index n, Eigen::Index m, const DirectionBlocks::Ranks& rank,
                     Eigen::Index count) {
  return n * rank[0] + m * rank[1] + count * rank[0] * rank[1];
}

/// visit(t, s, ranks) for every pair of runs, in their order.
template <typename Visit>
void for_each_pair(const DirectionBlocks& blocks, const Visit& visit) {
  for (int s = 1; s < blocks.n_runs(); ++s)
    for (int t = 0; t < s; ++t) visit(t, s, blocks.ranks[DirectionBlocks::pair(t, s)]);
}

}  // namespace

int DirectionBlocks::run_of(int jump) const {
  return static_cast<int>(std::ranges::upper_bound(begin, jump) - begin.begin()) - 1;
}

bool DirectionBlocks::is_partition_of(int n) const {
  if (begin.size() < 2 || begin.front() != 0 || begin.back() != n || !std::ranges::is_sorted(begin))
    return false;
  return ranks.size() == pair(0, n_runs());
}

Eigen::Index DirectionBlocks::near_size() const {
  Eigen::Index sum = 0;
  for (int run = 0; run < n_runs(); ++run) sum += Eigen::Index{n_in(run)} * n_in(run) * count;
  return sum;
}

Eigen::Index DirectionBlocks::far_size() const {
  Eigen::Index sum = 0;
  for_each_pair(*this, [&](int t, int s, const Ranks& rank) {
    sum += entries(n_in(t), n_in(s), rank, count);
  });
  return sum;
}

std::vector<int> jump_runs(int n) {
  const int n_runs = std::max(1, (n + kMostInRun - 1) / kMostInRun);
  std::vector<int> begin;
  for (int run = 0; run <= n_runs; ++run)
    begin.push_back(static_cast<int>(static_cast<long>(n) * run / n_runs));
  return begin;
}

DirectionSum::DirectionSum(const DirectionBlocks& blocks, Eigen::VectorXd factors)
    : blocks_(blocks), factors_(std::move(factors)) {
  FAULTSIM_DEMAND(factors_.size() == blocks_.count, factors_.size(), " factors of ", blocks_.count);
  Eigen::Index place = 0;
  for (int run = 0; run < blocks_.n_runs(); ++run) {
    near_begin_.push_back(place);
    place += Eigen::Index{blocks_.n_in(run)} * blocks_.n_in(run) * blocks_.count;
  }
  place = 0;
  for_each_pair(blocks_, [&](int t, int s, const DirectionBlocks::Ranks& rank) {
    far_begin_.push_back(place);
    place += entries(blocks_.n_in(t), blocks_.n_in(s), rank, blocks_.count);
  });
}

Eigen::MatrixXd DirectionSum::near(int run) const {
  const Eigen::Index n = blocks_.n_in(run);
  const float* block = blocks_.near.view().data() + near_begin_[static_cast<std::size_t>(run)];
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < factors_.size(); ++k)
    sum += factors_[k] * Eigen::Map<const Eigen::MatrixXf>(block + k * n * n, n, n).cast<double>();
  return sum;
}

/// The block of rows in run t and columns in run s, t < s.
Eigen::MatrixXd DirectionSum::far(int t, int s) const {
  using Floats = Eigen::Map<const Eigen::MatrixXf>;
  const std::size_t pair = DirectionBlocks::pair(t, s);
  const Eigen::Index n = blocks_.n_in(t), m = blocks_.n_in(s);
  const Eigen::Index r = blocks_.ranks[pair][0], q = blocks_.ranks[pair][1];
  const float* values = blocks_.far.view().data() + far_begin_[pair];
  const Floats u(values, n, r), v(values += n * r, m, q);
  values += m * q;
  Eigen::MatrixXd core = Eigen::MatrixXd::Zero(q, r);  // transposed, as the product takes it
  for (Eigen::Index k = 0; k < factors_.size(); ++k)
    core += factors_[k] * Floats(values + k * r * q, q, r).cast<double>();
  return times_transpose(times_transpose(u.cast<double>(), core), v.cast<double>());
}

void DirectionSum::add_columns(int run, Eigen::Ref<Eigen::MatrixXd> columns) const {
  columns.middleRows(blocks_.begin[run], blocks_.n_in(run)) += near(run);
  for (int other = 0; other < blocks_.n_runs(); ++other) {
    auto rows = columns.middleRows(blocks_.begin[other], blocks_.n_in(other));
    if (other < run) rows += far(other, run);
    if (other > run) rows += far(run, other).transpose();
  }
}

Eigen::VectorXd DirectionSum::diagonal() const {
  Eigen::VectorXd sum(blocks_.size());
  for (int run = 0; run < blocks_.n_runs(); ++run) {
    const Eigen::Index n = blocks_.n_in(run);
    const float* block = blocks_.near.view().data() + near_begin_[static_cast<std::size_t>(run)];
    for (Eigen::Index i = 0; i < n; ++i) {
      double entry = 0;
      for (Eigen::Index k = 0; k < factors_.size(); ++k)
        entry += factors_[k] * static_cast<double>(block[k * n * n + i * (n + 1)]);
      sum[blocks_.begin[run] + i] = entry;
    }
  }
  return sum;
}

}  // namespace faultsim
