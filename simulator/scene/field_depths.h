#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simulator/flow/flow_field.h"
#include "simulator/scene/geometry.h"

namespace faultsim {

struct Scene;

/// Which limit to take where p0 jumps (top and base of an overpressured reservoir layer) or σ_h
/// does (top and base of a lithostatic viscous layer).
enum class DepthSide {
  mean,   ///< of both limits.
  above,  ///< as seen from smaller depths.
  below,  ///< as seen from larger depths.
};

struct DepthInterval {
  double top = 0, bottom = 0;  ///< m, depths.
  bool holds(double depth, DepthSide side) const;
  /// The limit from within where a depth is an edge of this, to what meshes take for one line.
  DepthSide inner_side(double depth) const;
  /// Grows to hold another one.
  void unite(const DepthInterval& other);
};

/// Index of the reservoir layer; behind the last one where no layer has its name.
std::size_t reservoir_index(const FieldGeometry& field);
/// The reservoir layer of a field at zero offset; NaN where no layer has its name.
DepthInterval reservoir_range(const FieldGeometry& field);
/// The reservoir of a block: at its offset, of its own thickness if it has one.
DepthInterval reservoir_range(const FieldGeometry& field, const Block& block);

/// The blocks that a field's fault touches, west to east: one for the outer faults, else two.
std::span<const Block> blocks_beside(const FieldGeometry& field, std::size_t fault);
/// How far a fault reaches beyond the reservoirs beside it, m: its own overshoot or
/// fault_overshoot.
double overshoot_of(const FieldGeometry& field, std::size_t fault);
bool has_own_overshoot(const FieldGeometry& field, std::size_t fault);
/// How far the faults beside a block reach beyond its reservoir by fault_overshoot, m: 0 where both
/// have an overshoot of their own.
double common_overshoot(const FieldGeometry& field, std::size_t block);
/// From its overshoot above the shallowest to its overshoot below the deepest edge of the
/// reservoirs beside the fault.
DepthInterval fault_range(const FieldGeometry& field, std::size_t fault);
/// From the shallowest to the deepest point of its faults.
DepthInterval all_faults_range(const FieldGeometry& field);
/// Depths that must be grid lines, m: the surface and the base, tops of layers, edges of
/// reservoirs, tips of faults; in an order of their own, the same for all offsets.
std::vector<double> line_depths(const FieldGeometry& field);
/// The reservoir of a block between its faults, in their planes (flow_field.h).
CellCorners block_corners(const Scene& scene, std::size_t block);
/// x of a field's fault at the pivot depth, and at any, m.
double fault_x(const FieldGeometry& field, std::size_t fault);
double fault_x(const Scene& scene, std::size_t fault, double depth);

}  // namespace faultsim
