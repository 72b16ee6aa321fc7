#include "simulator/plan/cost.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace faultsim {
namespace {

constexpr int kLeafNodes = 8;
constexpr double kMostNodes = 2e6;  ///< that are dissected: their factor has a hundred gigabytes.

/// Fitted to operator builds on the calibration machine (results/plan); bytes and entries depend on
/// the program only, seconds on the machine too.
struct Rates {
  double seconds_per_cell;     ///< assembly, ordering, analysis.
  double bytes_per_cell;       ///< stiffness matrix, its copies, lists, mesh.
  double kept_bytes_per_cell;  ///< mesh and numbering.
  double factor_ratio;         ///< entries by METIS and CHOLMOD ÷ those of the dissected grid.
};
constexpr Rates kPlane{1.7e-5, 2.0e3, 650, 1.16};
constexpr Rates kSpace{7.0e-5, 6.3e3, 1000, 1.05};
constexpr double kUpdateShare = 0.5;
constexpr double kFlopRate = 4.4e10;    ///< 1/s, one thread.
constexpr double kReadRate = 2e10;      ///< bytes/s, in a substitution.
constexpr double kForwardRate = 3e10;   ///< 1/s, in a block of sparse forward substitutions.
constexpr double kForwardColumns = 64;  ///< columns that go up together (linalg/sparse_forward.h).

/// Two parts of a factor without a common way.
FactorSize operator+(const FactorSize& a, const FactorSize& b) {
  return {a.entries + b.entries, a.flops + b.flops, std::max(a.largest_update, b.largest_update),
          std::max(a.heaviest_way, b.heaviest_way)};
}

/// A front above a part.
FactorSize above(const FactorSize& front, const FactorSize& part) {
  FactorSize size = front + part;
  size.heaviest_way = front.heaviest_way + part.heaviest_way;
  return size;
}

/// s columns of a front with r rows below.
FactorSize front(double s, double r) {
  return {s * (s + r), s * (s * s / 3 + s * r + r * r), r * r, s * (s + r)};
}

/// A block of nodes; `open` per axis: whether planes of nodes bound it below and above.
struct NodeBlock {
  std::array<int, 3> from, to;
  std::array<std::array<bool, 2>, 3> open{};

  int extent(std::size_t axis) const { return to[axis] - from[axis]; }
  double n_nodes() const { return 1.0 * extent(0) * extent(1) * extent(2); }
};

class Dissection {
 public:
  explicit Dissection(const GridShape& shape) : shape_(shape) {}

  FactorSize size(const NodeBlock& block) {
    const double jumps = jumps_touching(block);
    if (jumps > 0) return cut(block, jumps);
    const auto [known, is_new] = fault_free_.try_emplace(key(block));
    if (!is_new) return known->second;
    const FactorSize result = cut(block, 0);
    return fault_free_[key(block)] = result;
  }

 private:
  /// Unknown jumps whose nodes lie in the block or next to it.
  double jumps_touching(const NodeBlock& block) const {
    double n = 0;
    for (const FaultWindow& fault : shape_.faults) {
      double here = fault.share;
      for (std::size_t a = 0; a < 3; ++a) {
        const int from = std::max(block.from[a] - 1, fault.lines[a].first);
        const int to = std::min(block.to[a] + 1, fault.lines[a].second);
        here *= std::max(0, to - from);
      }
      n += here;
    }
    return n * shape_.unknowns_per_node;
  }

  /// Nodes of the planes around the block.
  static double nodes_around(const NodeBlock& block) {
    double with = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      with *= block.extent(a) + block.open[a][0] + block.open[a][1];
    }
    return with - block.n_nodes();
  }

  FactorSize cut(const NodeBlock& block, double jumps) {
    const double d = shape_.unknowns_per_node;
    const double below = d * nodes_around(block) + jumps;
    std::size_t longest = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (block.extent(a) > block.extent(longest)) longest = a;
    }
    if (block.n_nodes() <= kLeafNodes || block.extent(longest) < 3) {
      return front(d * block.n_nodes(), below);
    }
    const int middle = block.from[longest] + block.extent(longest) / 2;
    NodeBlock low = block, high = block;
    low.to[longest] = middle;
    high.from[longest] = middle + 1;
    low.open[longest][1] = high.open[longest][0] = true;
    const double separator = d * block.n_nodes() / block.extent(longest);
    return above(front(separator, below), size(low) + size(high));
  }

  static std::uint64_t key(const NodeBlock& block) {
    std::uint64_t k = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      k = k << 21 | static_cast<std::uint64_t>(block.extent(a)) << 2 |
          static_cast<std::uint64_t>(block.open[a][0]) << 1 |
          static_cast<std::uint64_t>(block.open[a][1]);
    }
    return k;
  }

  const GridShape& shape_;
  std::unordered_map<std::uint64_t, FactorSize> fault_free_;
};

/// Of a grid far too large to be run: a coarser one, and the growth of its largest cuts with the
/// nodes n, n^(2(d−1)/d) entries and n^(3(d−1)/d) flops in d dimensions.
FactorSize extrapolated_factor(const GridShape& shape) {
  const double d = shape.unknowns_per_node;  // as many as dimensions
  const double k = 1.01 * std::pow(shape.n_nodes() / kMostNodes, 1 / d);
  const auto coarser = [&](int lines) { return std::max(1, static_cast<int>(lines / k)); };
  GridShape small = shape;
  for (std::size_t a = 0; a < 3; ++a) {
    small.n_lines[a] = coarser(shape.n_lines[a]);
    for (FaultWindow& fault : small.faults) {
      auto& [from, to] = fault.lines[a];
      const int extent = to - from;
      from = static_cast<int>(from / k);
      to = from + (extent > 0 ? coarser(extent) : 0);
    }
  }
  const FactorSize size = dissected_factor(small);
  const double cut = std::pow(shape.n_nodes() / small.n_nodes(), (d - 1) / d);
  return {cut * cut * size.entries, cut * cut * cut * size.flops, cut * cut * size.largest_update,
          cut * cut * size.heaviest_way};
}

}  // namespace

double GridShape::n_cells() const {
  double n = 1;
  for (const int lines : n_lines) n *= std::max(1, lines - 1);
  return n;
}

double GridShape::n_jump() const {
  double n = 0;
  for (const FaultWindow& fault : faults) {
    double here = fault.share;
    for (const auto& [from, to] : fault.lines) here *= std::max(0, to - from);
    n += here;
  }
  return n * unknowns_per_node;
}

FactorSize dissected_factor(const GridShape& shape) {
  if (shape.n_nodes() > kMostNodes) return extrapolated_factor(shape);
  Dissection dissection(shape);
  const double jumps = shape.n_jump();
  FactorSize size = dissection.size({{0, 0, 0}, shape.n_lines});
  const double way = size.heaviest_way;
  size = size + front(jumps, 0);
  size.heaviest_way = way;
  return size;
}

OperatorCost operator_cost(const GridShape& shape) {
  const Rates& rates = shape.unknowns_per_node == 2 ? kPlane : kSpace;
  const FactorSize factor = dissected_factor(shape);
  const double cells = shape.n_cells(), jumps = shape.n_jump();
  const double h_bytes = 8 * jumps * jumps;
  OperatorCost cost;
  cost.factor_bytes = 8 * rates.factor_ratio * factor.entries;
  cost.kept_bytes = rates.kept_bytes_per_cell * cells + h_bytes;
  // While it is factorised: K, its copies and lists, the block that a front adds to those above.
  const double factorising =
      rates.bytes_per_cell * cells + 8 * kUpdateShare * factor.largest_update;
  const double condensing = cost.kept_bytes + 2 * h_bytes;  // L_gg and a copy of H
  cost.peak_bytes = cost.factor_bytes + std::max(factorising, condensing);
  // H = L_gg L_ggᵀ takes jumps³ operations; each load reads the factor once.
  cost.seconds = rates.seconds_per_cell * cells + (factor.flops + jumps * h_bytes / 8) / kFlopRate +
                 shape.n_loads * cost.factor_bytes / kReadRate;
  return cost;
}

InfluenceCost influence_cost(const GridShape& shape, double n_cells, double n_observed) {
  const Rates& rates = shape.unknowns_per_node == 2 ? kPlane : kSpace;
  const OperatorCost op = operator_cost(shape);
  const double way = rates.factor_ratio * dissected_factor(shape).heaviest_way;
  const double jumps = shape.n_jump();
  InfluenceCost cost;
  cost.bytes = 8 * (jumps + n_observed) * n_cells;
  // Rows are scattered and taken one by one, at the rate of memory; panels at that of dgemm.
  cost.seconds = 2 * way * n_cells / kForwardRate + 4 * cost.bytes / kReadRate +
                 n_observed * 2 * op.factor_bytes / kReadRate;
  const double workspace = 8.0 * kForwardColumns * shape.unknowns_per_node * shape.n_nodes();
  cost.peak_bytes = op.factor_bytes + op.kept_bytes + 8 * jumps * jumps + cost.bytes + workspace;
  return cost;
}

}  // namespace faultsim
