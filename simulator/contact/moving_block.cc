#include "simulator/contact/moving_block.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "simulator/common/thread_team.h"

namespace faultsim {
namespace {

constexpr int kDofs = MovingBlock::kDofs;
constexpr int kUnit = 64;  // nodes whose rows are whole blocks of ShortColumns
constexpr int kBlocksInUnit = kDofs * kUnit / ShortColumns::kScaled;
static_assert(kBlocksInUnit * ShortColumns::kScaled == kDofs * kUnit);

/// Steps of a product that are behind a range of rows, on a line of memory of their own.
struct alignas(64) StepsDone {
  std::atomic<int> n_steps = 0;
};

/// z := G x in ranges of rows, by a thread each. A step is a place. Every range takes all steps in
/// their order, each step after the range above has: so each entry of z has its terms, and each
/// place its sums over rows, in the order that one range of all rows gives them.
class RangedProduct {
 public:
  RangedProduct(const MovingBlock& block, const std::vector<int>& places, const Eigen::VectorXf& x,
                int n_ranges)
      : block_(block), places_(places), x_(x), sums_(places.size()), done_(n_ranges) {}

  void add(int range, Eigen::VectorXf& z);

 private:
  int first_unit(int range) const {
    const int n_units = (block_.n_nodes() + kUnit - 1) / kUnit;
    // 0.5 would be ranges of equal work, as the first rows have the most columns; those below begin
    // later.
    constexpr double kPower = 0.6;
    const double below = 1 - static_cast<double>(range) / static_cast<double>(done_.size());
    return static_cast<int>(std::round(n_units * (1 - std::pow(below, kPower))));
  }
  int steps_behind(int range, int more_than) const;

  const MovingBlock& block_;
  const std::vector<int>& places_;
  const Eigen::VectorXf& x_;
  std::vector<ShortColumns::Lanes> sums_;  ///< per step, over the rows so far.
  std::vector<StepsDone> done_;            ///< per range.
};

/// Waits until a range has more steps behind it. @returns how many.
int RangedProduct::steps_behind(int range, int more_than) const {
  int n_steps = 0;
  for (int round = 0;; wait_a_moment(round++)) {
    n_steps = done_[range].n_steps.load(std::memory_order_acquire);
    if (n_steps > more_than) return n_steps;
  }
}

void RangedProduct::add(int range, Eigen::VectorXf& z) {
  constexpr int kTold = 16;  // steps after which the range below is told
  constexpr int kAhead = 4;  // steps for which sums come from another core
  const int first = first_unit(range), last = first_unit(range + 1);
  const auto n_steps = static_cast<int>(places_.size());
  int n_free = range == 0 ? n_steps : 0;  // to be taken without waiting
  for (int step = 0; step < n_steps; ++step) {
    if (step % kTold == 0) done_[range].n_steps.store(step, std::memory_order_release);
    const int place = places_[step];
    if (place < kUnit * first) continue;  // none of its rows are here
    if (step >= n_free) n_free = steps_behind(range - 1, step);
    if (step + kAhead < n_free) sums_[step + kAhead].fetch();
    const ShortColumns& before = block_.before(place);
    const ShortColumns& next = block_.before(places_[std::min(step + 1, n_steps - 1)]);
    const Eigen::Vector3f own = x_.segment<kDofs>(Eigen::Index{kDofs} * place);
    before.multiply_blocks(kBlocksInUnit * first, std::min(kBlocksInUnit * last, before.n_blocks()),
                           {own[0], own[1], own[2]}, x_.data(), z.data(), sums_[step], next);
    if (place >= kUnit * last) continue;
    const auto others = sums_[step].total();
    z.segment<kDofs>(Eigen::Index{kDofs} * place) +=
        block_.own(place) * own + Eigen::Vector3f(others[0], others[1], others[2]);
  }
  done_[range].n_steps.store(n_steps, std::memory_order_release);
}

}  // namespace

MovingBlock::MovingBlock(const ContactProblem& problem)
    : problem_(problem), place_(static_cast<std::size_t>(problem.n_nodes()), -1) {}

void MovingBlock::clear() {
  for (const int k : node_) place_[k] = -1;
  node_.clear();
  dofs_.clear();
  own_.clear();
  before_.clear();
}

void MovingBlock::add(const std::vector<int>& nodes) {
  constexpr std::size_t kWorth = 10'000;  // pairs of nodes that are gathered in 0.1 ms
  const int n_before = n_nodes();
  std::vector<Columns> columns;
  for (const int k : nodes) {
    place_[k] = n_nodes();
    node_.push_back(k);
    Columns of_node{};
    for (int c = 0; c < kDofs; ++c) {
      const int dof = problem_.nodes[k].dof[c];
      dofs_.push_back(dof);
      if (dof >= 0) of_node[c] = problem_.compliance.column(dof).data();  // may have to be made
    }
    columns.push_back(of_node);
  }
  own_.resize(node_.size());
  before_.resize(node_.size());
  const bool is_much = nodes.size() * node_.size() > kWorth;
  for_each(is_much ? problem_.team : nullptr, static_cast<int>(nodes.size()),
           [&](int i) { gather(n_before + i, columns[i]); });
}

/// What the node there does to itself and to those before it.
void MovingBlock::gather(int place, const Columns& columns) {
  const Eigen::Index n_before = Eigen::Index{kDofs} * place;
  Eigen::MatrixX3f gathered = Eigen::MatrixX3f::Zero(n_before + kDofs, kDofs);
  for (int c = 0; c < kDofs; ++c) {
    const double* h = columns[c];
    if (h == nullptr) continue;
    for (Eigen::Index r = 0; r < n_before + kDofs; ++r) {
      const int dof = dofs_[r];
      if (dof >= 0) gathered(r, c) = static_cast<float>(h[dof]);
    }
  }
  own_[place] = gathered.bottomRows<kDofs>();
  before_[place] = ShortColumns(gathered.topRows(n_before));
}

void MovingBlock::multiply(const std::vector<int>& places, const Eigen::VectorXf& x,
                           Eigen::VectorXf& z) const {
  ThreadTeam* team = places.size() < kShared ? nullptr : problem_.team;
  const int n_ranges = team == nullptr ? 1 : team->n_threads();
  z.setZero(n_vector());
  RangedProduct product(*this, places, x, n_ranges);
  for_each(team, n_ranges, [&](int range) { product.add(range, z); });
}

}  // namespace faultsim
