#include "simulator/linalg/corner_dissection.h"

#include <algorithm>
#include <bit>

#include "simulator/common/errors.h"
#include "simulator/linalg/ordering.h"

namespace faultsim {
namespace {

constexpr unsigned kCornersOfDomain = 16;  // at least

/// The corners of a graph, numbered, and the graph of those that share an edge.
struct Corners {
  std::vector<int> number;  ///< per vertex of the whole; −1 = in the middle of a side.
  int n = 0;
  GroupGraph graph;
};

Corners corners_of(const GroupGraph& graph, const std::vector<std::array<int, 2>>& ends) {
  Corners corners;
  for (const auto& [a, b] : ends) corners.number.push_back(a < 0 && b < 0 ? corners.n++ : -1);
  corners.graph.begin.push_back(0);
  for (std::size_t v = 0; v < ends.size(); ++v) {
    if (corners.number[v] < 0) continue;
    for (long k = graph.begin[v]; k < graph.begin[v + 1]; ++k) {
      const int other = corners.number[graph.rows[k]];
      if (other >= 0) corners.graph.rows.push_back(other);
    }
    corners.graph.begin.push_back(std::ssize(corners.graph.rows));
  }
  return corners;
}

/// The set of each vertex: a corner's own, otherwise that of the end that is eliminated first.
std::vector<SuiteSparse_long> sets_of_all(const Corners& corners,
                                          const std::vector<std::array<int, 2>>& ends,
                                          const std::vector<int>& set_of_corner) {
  const auto set_of = [&](int vertex) { return set_of_corner[corners.number[vertex]]; };
  std::vector<SuiteSparse_long> sets;
  for (int v = 0; v < static_cast<int>(ends.size()); ++v) {
    const auto& [a, b] = ends[v];
    sets.push_back(corners.number[v] >= 0 ? set_of(v)
                   : a < 0                ? set_of(b)
                   : b < 0                ? set_of(a)
                                          : std::min(set_of(a), set_of(b)));
  }
  return sets;
}

}  // namespace

std::optional<std::vector<long>> corner_dissection(GroupGraph& graph,
                                                   const std::vector<std::array<int, 2>>& ends,
                                                   const std::function<bool()>& stop) {
  const Corners corners = corners_of(graph, ends);
  const auto n_domains =
      static_cast<int>(std::bit_floor(static_cast<unsigned>(corners.n) / kCornersOfDomain));
  if (n_domains < 2) return {};
  const std::optional<std::vector<int>> sets = dissected_sets(corners.graph, n_domains, stop);
  if (!sets) return {};
  std::vector<SuiteSparse_long> constraint = sets_of_all(corners, ends, *sets);
  std::vector<SuiteSparse_long> order(ends.size());
  CholmodCommon common;
  cholmod_sparse a = pattern_of(graph);
  const int done = cholmod_l_camd(&a, nullptr, 0, constraint.data(), order.data(), common.get());
  if (common.get()->status == CHOLMOD_OUT_OF_MEMORY) throw ResourceError("not enough memory");
  FAULTSIM_DEMAND(done == 1, "CAMD failed, CHOLMOD status ", common.get()->status);
  return order;
}

}  // namespace faultsim
