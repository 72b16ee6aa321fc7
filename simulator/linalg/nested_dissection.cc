#include "simulator/linalg/nested_dissection.h"

#include <metis.h>

#include <array>
#include <bit>
#include <csignal>
#include <limits>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/linalg/metis_turn.h"

namespace faultsim {
namespace {

using Index = long;

/// Both triangles, as METIS wants them; neighbours ascending.
struct Adjacency {
  std::vector<idx_t> begin, neighbours;
};

Adjacency adjacency(const GroupGraph& graph) {
  const idx_t n = static_cast<idx_t>(graph.begin.size()) - 1;
  const std::vector<idx_t> rows(graph.rows.begin(), graph.rows.end());
  Adjacency full;
  full.begin.assign(n + 1, 0);
  const auto for_each_edge = [&](const auto& visit) {  // (j, larger), both ascending
    for (idx_t j = 0; j < n; ++j) {
      for (Index k = graph.begin[j]; k < graph.begin[j + 1]; ++k) visit(j, rows[k]);
    }
  };
  for_each_edge([&](idx_t i, idx_t j) { ++full.begin[i + 1], ++full.begin[j + 1]; });
  std::partial_sum(full.begin.begin(), full.begin.end(), full.begin.begin());
  full.neighbours.resize(2 * rows.size());
  std::vector<idx_t> next(full.begin.begin(), full.begin.end() - 1);
  for_each_edge([&](idx_t i, idx_t j) {
    full.neighbours[next[i]++] = j;
    full.neighbours[next[j]++] = i;
  });
  return full;
}

bool is_countable(const GroupGraph& graph) {
  return 2 * graph.rows.size() <= static_cast<std::size_t>(std::numeric_limits<idx_t>::max());
}

/// Sizes of the sets below a separator and its own, in the order of elimination. METIS lists them
/// by levels, domains first, from left to right: the two halves of the k-th of a level are the
/// 2k-th and the next of the level before.
void append_sizes(const std::vector<idx_t>& by_level, std::size_t level_begin,
                  std::size_t level_size, std::size_t k, std::vector<idx_t>& sizes) {
  const std::size_t below_size = 2 * level_size;
  if (below_size <= (by_level.size() + 1) / 2) {
    const std::size_t below = level_begin - below_size;
    append_sizes(by_level, below, below_size, 2 * k, sizes);
    append_sizes(by_level, below, below_size, 2 * k + 1, sizes);
  }
  sizes.push_back(by_level[level_begin + k]);
}

}  // namespace

std::optional<std::vector<Index>> nested_dissection(const GroupGraph& graph,
                                                    const std::function<bool()>& stop) {
  if (!is_countable(graph)) return {};
  Adjacency full = adjacency(graph);
  idx_t n = static_cast<idx_t>(full.begin.size()) - 1;
  std::vector<idx_t> order(n), place(n);
  const std::unique_lock turn = turn_of_metis(stop);
  while (true) {
    require_no_stop(stop);
    int done = METIS_ERROR;
    {
      const KeptSignalActions kept;
      done = METIS_NodeND(&n, full.begin.data(), full.neighbours.data(), nullptr, nullptr,
                          order.data(), place.data());
    }
    require_no_stop(stop);
    if (done == METIS_OK) return std::vector<Index>(order.begin(), order.end());
    if (done == METIS_ERROR_MEMORY) return {};
    FAULTSIM_DEMAND(done == METIS_ERROR, "METIS_NodeND returns ", done);
    std::raise(SIGTERM);
  }
}

std::optional<std::vector<int>> dissected_sets(const GroupGraph& graph, int n_domains,
                                               const std::function<bool()>& stop) {
  FAULTSIM_DEMAND(n_domains >= 2 && std::has_single_bit(static_cast<unsigned>(n_domains)),
                  n_domains, " domains");
  if (!is_countable(graph)) return {};
  Adjacency full = adjacency(graph);
  const auto n = static_cast<idx_t>(full.begin.size()) - 1;
  std::vector<idx_t> order(n), place(n), by_level(2 * n_domains - 1), options(METIS_NOPTIONS);
  METIS_SetDefaultOptions(options.data());
  const std::unique_lock turn = turn_of_metis(stop);
  require_no_stop(stop);
  const int done = METIS_NodeNDP(n, full.begin.data(), full.neighbours.data(), nullptr, n_domains,
                                 options.data(), order.data(), place.data(), by_level.data());
  require_no_stop(stop);
  if (done != METIS_OK) return {};
  std::vector<idx_t> sizes;
  append_sizes(by_level, by_level.size() - 1, 1, 0, sizes);
  std::vector<int> set_at;  // a place
  for (std::size_t s = 0; s < sizes.size(); ++s)
    set_at.insert(set_at.end(), sizes[s], static_cast<int>(s));
  if (std::ssize(set_at) != n) return {};
  std::vector<int> sets(n);
  for (idx_t v = 0; v < n; ++v) sets[v] = set_at[place[v]];
  return sets;
}

}  // namespace faultsim
