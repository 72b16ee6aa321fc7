#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/horizons/cut_map.h"

namespace faultsim::horizons {

/// How far each fault has moved a place of the cut map up, m, where its throw is full in depth;
/// FaultThrow says how. n_places x n_faults.
Eigen::MatrixXd throw_fields(const LayeredBody& body, const MapMesh& map, const CutMap& cut);

/// The part of its throw that a fault has at a depth, [0, 1].
double throw_in_depth(const LayeredFault& fault, double z);

}  // namespace faultsim::horizons
