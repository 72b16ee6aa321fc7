#include "simulator/linalg/ordering.h"

#include <algorithm>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/linalg/corner_dissection.h"
#include "simulator/linalg/nested_dissection.h"

namespace faultsim {
namespace {

using Index = SuiteSparse_long;

// Below this nested dissection has nothing to gain on minimum degree.
constexpr int kSmallGraph = 500;
constexpr Index kNoParent = -1;  // CHOLMOD's EMPTY

GroupGraph group_graph(const cholmod_sparse& a, const UnknownGroups& groups) {
  const std::vector<int>& group = groups.of;
  const int n_groups = groups.n;
  const Index* begin = static_cast<const Index*>(a.p);
  const Index* rows = static_cast<const Index*>(a.i);
  const Index n_bulk = static_cast<Index>(group.size());
  std::vector<std::vector<Index>> members(static_cast<std::size_t>(n_groups));
  for (Index j = 0; j < n_bulk; ++j) {
    const int g = group[j];
    FAULTSIM_DEMAND(g >= 0 && g < n_groups, "group ", g, " of ", n_groups);
    members[g].push_back(j);
  }
  std::vector<std::vector<Index>> below(static_cast<std::size_t>(n_groups));
  std::vector<int> seen_by(static_cast<std::size_t>(n_groups), -1);
  for (int g = 0; g < n_groups; ++g) {
    for (Index j : members[g]) {
      for (Index k = begin[j]; k < begin[j + 1] && rows[k] < n_bulk; ++k) {
        const int other = group[rows[k]];
        if (other == g || seen_by[other] == g) continue;
        seen_by[other] = g;
        below[std::min(g, other)].push_back(std::max(g, other));
      }
    }
  }
  GroupGraph graph;
  graph.begin.push_back(0);
  for (auto& list : below) {
    std::ranges::sort(list);
    drop_repeated(list);
    graph.rows.insert(graph.rows.end(), list.begin(), list.end());
    graph.begin.push_back(static_cast<Index>(graph.rows.size()));
  }
  return graph;
}

std::vector<Index> order_groups(GroupGraph graph, const std::vector<std::array<int, 2>>& ends,
                                CholmodCommon& common, const std::function<bool()>& stop) {
  const std::size_t n = graph.begin.size() - 1;
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  if (graph.rows.empty()) return order;
  if (n >= kSmallGraph) {
    std::optional<std::vector<Index>> dissected;
    if (!ends.empty()) dissected = corner_dissection(graph, ends, stop);
    if (!dissected) dissected = nested_dissection(graph, stop);
    if (dissected) return *dissected;
  }
  cholmod_sparse a = pattern_of(graph);
  const int done = cholmod_l_amd(&a, nullptr, 0, order.data(), common.get());
  FAULTSIM_DEMAND(done == 1, "AMD failed, CHOLMOD status ", common.get()->status);
  return order;
}

/// Postorders the bulk unknowns of `order` by their elimination tree.
void postorder_bulk(cholmod_sparse& a, Index n_bulk, std::vector<Index>& order,
                    CholmodCommon& common) {
  const std::size_t n = order.size();
  std::vector<Index> parent(n), post(n), count(n), first(n), level(n);
  const int analysed = cholmod_l_analyze_ordering(&a, CHOLMOD_GIVEN, order.data(), nullptr, 0,
                                                  parent.data(), post.data(), count.data(),
                                                  first.data(), level.data(), common.get());
  FAULTSIM_DEMAND(analysed == 1, "CHOLMOD status ", common.get()->status);
  // All trees of the bulk hang from the first trailing unknown, and the trailing ones form a chain:
  // any postorder of that tree ends with them, in their order.
  for (std::size_t i = 0; i < n; ++i) {
    if (static_cast<Index>(i) >= n_bulk) {
      parent[i] = i + 1 < n ? static_cast<Index>(i) + 1 : kNoParent;
    } else if (parent[i] >= n_bulk || parent[i] == kNoParent) {
      parent[i] = n_bulk < static_cast<Index>(n) ? n_bulk : kNoParent;
    }
  }
  const Index placed =
      cholmod_l_postorder(parent.data(), n, count.data(), post.data(), common.get());
  FAULTSIM_DEMAND(placed == static_cast<Index>(n), placed, " of ", n);
  std::vector<Index> result(n);
  for (std::size_t i = 0; i < n; ++i) result[i] = order[post[i]];
  order = std::move(result);
}

}  // namespace

cholmod_sparse pattern_of(GroupGraph& graph) {
  cholmod_sparse a{};
  a.nrow = a.ncol = graph.begin.size() - 1;
  a.nzmax = graph.rows.size();
  a.p = graph.begin.data();
  a.i = graph.rows.data();
  a.stype = -1;
  a.itype = CHOLMOD_LONG;
  a.xtype = CHOLMOD_PATTERN;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = a.packed = 1;
  return a;
}

std::vector<Index> trailing_order(cholmod_sparse& a, Index n_bulk, const UnknownGroups& groups,
                                  CholmodCommon& common, const std::function<bool()>& stop) {
  const std::vector<int>& group = groups.of;
  FAULTSIM_DEMAND(groups.ends.empty() || std::ssize(groups.ends) == groups.n, groups.ends.size());
  const std::vector<Index> group_order =
      order_groups(group_graph(a, groups), groups.ends, common, stop);
  std::vector<Index> place(group_order.size());
  for (std::size_t i = 0; i < group_order.size(); ++i) {
    place[group_order[i]] = static_cast<Index>(i);
  }
  std::vector<Index> order(a.nrow);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.begin() + n_bulk,
                   [&](Index i, Index j) { return place[group[i]] < place[group[j]]; });
  postorder_bulk(a, n_bulk, order, common);
  for (std::size_t i = static_cast<std::size_t>(n_bulk); i < order.size(); ++i) {
    FAULTSIM_DEMAND(order[i] == static_cast<Index>(i), "trailing unknown ", i, " moved");
  }
  return order;
}

}  // namespace faultsim
