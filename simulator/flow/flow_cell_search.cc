#include "simulator/flow/flow_cell_search.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr int kLeaf = 8;  ///< cells that are looked at one by one.

}  // namespace

FlowCellSearch::FlowCellSearch(const std::vector<FlowCell>& cells) : cells_(cells) {
  FAULTSIM_DEMAND(!cells.empty(), "no cells");
  order_.resize(cells.size());
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int>(cells.size()));
}

Eigen::Vector3d FlowCellSearch::centre_of(int cell) const {
  return 0.5 * (cells_[cell].low + cells_[cell].high);
}

void FlowCellSearch::build(int begin, int end) {
  Node node{.box = {}, .begin = begin, .end = end, .second_child = -1};
  for (int i = begin; i < end; ++i)
    node.box.extend(cells_[order_[i]].low).extend(cells_[order_[i]].high);
  const std::size_t number = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return;
  Eigen::Index axis = 0;
  node.box.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) { return centre_of(a)[axis] < centre_of(b)[axis]; });
  build(begin, middle);
  nodes_[number].second_child = static_cast<int>(nodes_.size());
  build(middle, end);
}

std::vector<int> FlowCellSearch::overlapping(const Eigen::Vector3d& low,
                                             const Eigen::Vector3d& high) const {
  const auto meets = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (from.array() < high.array()).all() && (to.array() > low.array()).all();
  };
  std::vector<int> found;
  std::vector<int> open{0};
  while (!open.empty()) {
    const int number = open.back();
    const Node& node = nodes_[number];
    open.pop_back();
    if (!meets(node.box.min(), node.box.max())) continue;
    if (node.second_child >= 0) {
      open.push_back(number + 1);
      open.push_back(node.second_child);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const FlowCell& cell = cells_[order_[i]];
      if (meets(cell.low, cell.high)) found.push_back(order_[i]);
    }
  }
  std::ranges::sort(found);
  return found;
}

int FlowCellSearch::nearest(const Eigen::Vector3d& point) const {
  // A centre lies in its cell's box: no cell of a node is nearer than the node's box.
  const auto bound = [&](int node) { return nodes_[node].box.squaredExteriorDistance(point); };
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  std::vector<int> open{0};
  while (!open.empty()) {
    const int number = open.back();
    const Node& node = nodes_[number];
    open.pop_back();
    // The slack keeps equals from being dropped by the rounding of the bound.
    if (bound(number) > least * (1 + 1e-12)) continue;
    if (node.second_child >= 0) {
      const int first = number + 1;
      const bool is_first_nearer = bound(first) <= bound(node.second_child);
      open.push_back(is_first_nearer ? node.second_child : first);
      open.push_back(is_first_nearer ? first : node.second_child);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const int cell = order_[i];
      const double distance = (centre_of(cell) - point).squaredNorm();
      if (distance > least || (distance == least && cell > best)) continue;
      least = distance;
      best = cell;
    }
  }
  return best;
}

}  // namespace faultsim
