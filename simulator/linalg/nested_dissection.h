#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace faultsim {

/// Pattern of an undirected graph: of each vertex its neighbours of higher number, ascending
/// (a lower triangle by columns, without diagonal).
struct GroupGraph {
  std::vector<long> begin, rows;
};

/// Fill-reducing order by METIS's nested dissection (METIS_NodeND with its default options):
/// entry k is the vertex that is eliminated as the k-th. Nothing if METIS has no memory for it or
/// the graph more edges than its integers count.
/// METIS draws from the process's rand(), so that one call runs at a time in a process, and takes
/// SIGTERM for itself: it is given back at once, and what METIS caught before is raised again.
/// @param stop  asked while it waits its turn, and before and after METIS.
/// Throws Interrupted when `stop` says so.
std::optional<std::vector<long>> nested_dissection(const GroupGraph& graph,
                                                   const std::function<bool()>& stop = nullptr);

/// Domains and separators of nested dissection (METIS_NodeNDP with its default options) down to
/// `n_domains`, a power of 2: of each vertex the number of its set. Sets are numbered from 0 on in
/// the order of elimination, both halves before the separator between them.
/// Nothing where the graph falls apart before it has as many, or as above.
std::optional<std::vector<int>> dissected_sets(const GroupGraph& graph, int n_domains,
                                               const std::function<bool()>& stop = nullptr);

}  // namespace faultsim
