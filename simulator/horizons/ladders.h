#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "simulator/horizons/pillar_nodes.h"

namespace faultsim::horizons {

/// The wall between two neighbouring pillars as triangles from the base to the top: which of both
/// ends, a (0) or b (1) of the side, goes up to its next node.
using Ladder = std::vector<std::uint8_t>;

/// The walls over all sides of the map. Horizons of what is beside them, of both sides at a fault,
/// and the ends of faults in depth are edges of them. Between two such lines the pillar goes up
/// whose next step has its middle at the lower part of the way, so that edges across stay level; of
/// equal ones the pillar with less of `order`.
std::vector<Ladder> make_ladders(const MapMesh& map, const CutMap& cut,
                                 const std::vector<MapSide>& sides, const PillarNodes& nodes,
                                 const std::vector<double>& order);

/// Which pillar should go up first where both may: against the way that pillars lean, so that edges
/// across leaning walls are short. Per vertex.
std::vector<double> order_of_pillars(const LayeredBody& body, const MapMesh& map,
                                     const Pillars& pillars);

}  // namespace faultsim::horizons
