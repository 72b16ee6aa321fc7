#include "simulator/surface/adaptive_interpolant.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace faultsim {
namespace {

/// Of the surplus of the node before. An odd function has none at −1 once 0 and 1 are there: a
/// surplus that is small by chance must not end an axis.
constexpr double kDistrust = 0.1;

}  // namespace

AdaptiveInterpolant::AdaptiveInterpolant(int n_axes, Surplus surplus)
    : look_(std::move(surplus)), grid_(n_axes) {
  own_.push_back(0);
  surplus_.push_back(std::numeric_limits<double>::infinity());
  is_old_.push_back(false);
}

/// Every index that is one less on one axis is there, and its successors were looked at.
bool AdaptiveInterpolant::may_add(const SparseGrid::Index& index) const {
  if (!grid_.admits(index)) return false;
  const auto& known = grid_.indices();
  for (std::size_t axis = 0; axis < index.size(); ++axis) {
    if (index[axis] == 0) continue;
    SparseGrid::Index before = index;
    --before[axis];
    const auto found = std::ranges::find(known, before);
    if (!is_old_[found - known.begin()]) return false;
  }
  return true;
}

void AdaptiveInterpolant::add(const SparseGrid::Index& index) {
  const Eigen::VectorXd x = SparseGrid::place(index);
  const double own = look_(x, grid_.weights(x));
  double least = 0;
  for (std::size_t axis = 0; axis < index.size(); ++axis) {
    SparseGrid::Index before = index;
    if (--before[axis] <= 0) continue;  // the centre has no surplus, and 1 none before it
    const auto found = std::ranges::find(grid_.indices(), before);
    const double of_before = own_[found - grid_.indices().begin()];
    least = std::max(least, kDistrust * of_before);
  }
  grid_.add(index);
  own_.push_back(own);
  surplus_.push_back(std::max(own, least));
  is_old_.push_back(false);
}

/// A node is not old as long as there is no room for all of its successors: it gets the others when
/// there is.
void AdaptiveInterpolant::expand(std::size_t node, int most) {
  is_old_[node] = true;
  const SparseGrid::Index index = grid_.indices()[node];
  for (const SparseGrid::Index& next : grid_.successors(index)) {
    if (!may_add(next)) continue;
    if (grid_.n_nodes() >= most) {
      is_old_[node] = false;
      return;
    }
    add(next);
  }
}

double AdaptiveInterpolant::grow(double tolerance, int most) {
  while (true) {
    double largest = 0;
    std::size_t worst = own_.size();
    for (std::size_t k = 0; k < own_.size(); ++k) {
      if (is_old_[k] || surplus_[k] <= largest) continue;
      largest = surplus_[k];
      worst = k;
    }
    if (largest <= tolerance || grid_.n_nodes() >= most) return largest;
    expand(worst, most);
  }
}

}  // namespace faultsim
