#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "simulator/linalg/nested_dissection.h"

namespace faultsim {

/// Fill-reducing order of the nodes of quadratic cells: entry k is the node that is eliminated as
/// the k-th.
///
/// The graph of the corners alone is dissected (METIS), down to domains of some 20: a separator of
/// corners with the nodes in the middle of the sides between them separates the whole, and the
/// small graph is cut better, and in a twentieth of the time, than that of all nodes. A node in the
/// middle of a side goes with the end that is eliminated first. Within domains and separators the
/// order is that of constrained minimum degree (CAMD) on the graph of all nodes. Against dissecting
/// all nodes: 0.78 of the operations and 0.9 of the entries (results/tetrahedra).
///
/// @param ends  per vertex, see UnknownGroups.
/// @returns nothing where METIS does not dissect that far.
/// Throws ResourceError when memory is short, Interrupted when `stop` says so.
std::optional<std::vector<long>> corner_dissection(GroupGraph& graph,
                                                   const std::vector<std::array<int, 2>>& ends,
                                                   const std::function<bool()>& stop);

}  // namespace faultsim
