#pragma once

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
/// Throws Interrupted if a stop signal came meanwhile: METIS takes SIGTERM for itself, so that one
/// is raised again for the program once METIS is gone.
std::optional<std::vector<long>> nested_dissection(const GroupGraph& graph);

}  // namespace faultsim
