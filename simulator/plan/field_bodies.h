#pragma once

#include <vector>

#include "simulator/flow/flow_mapping.h"
#include "simulator/plan/plan.h"

namespace faultsim {

/// What a flow grid should cover, as bodies to map: their `region` is a compartment, or
/// n_compartments + a fault for the parts of the reservoir beside it.
///
/// Of a field: the hexahedron of each block's reservoir between its faults, and the slices of those
/// within kBesideFault of a fault. Of a box: the cells of its mesh in regions, then those that
/// touch a fault. In plane strain their section at y (at_section).
std::vector<MappedCell> field_bodies(const Scene& scene, const Plan& plan, double y);

/// The cells of a mesh that lie in compartments, as a run maps fields onto them: in order, in plane
/// strain their section at y.
std::vector<MappedCell> cells_of_compartments(const Mesh& mesh, double y);

inline constexpr double kBesideFault = 100;  ///< m, in x.

/// The corners of a cell of a mesh for the mapping of a field: a tetrahedron is a hexahedron whose
/// corners are each there twice, so that its centre and its volume are the tetrahedron's.
CellCorners corners_of_cell(const Mesh& mesh, int cell);

}  // namespace faultsim
