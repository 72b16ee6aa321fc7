#pragma once

#include <cstddef>
#include <vector>

#include "simulator/scene/geometry.h"

/// Over which offsets of a block a mesh keeps its cells.
namespace faultsim {

/// Of a gap between two depths that must be grid lines: by how much it may change from where the
/// lines were laid out for it (FieldMeshSpec).
inline constexpr double kLeastStretch = 0.5, kLargestStretch = 2.5;

struct OffsetInterval {
  double from = 0, to = 0;  ///< m.
  double layout = 0;        ///< m, for which grid lines are laid out: Block::mesh_offset.
  bool holds(double offset) const { return offset >= from && offset <= to; }
};

/// Intervals of a block's offset, ascending and side by side, over each of which lines laid out for
/// one offset can be moved to all others: as few as cover [from, to], all other blocks held. They
/// end where two of the depths that must be lines would meet, and stay away from there by an
/// eightieth of the distance between two such offsets, 2 m at most: what is nearer has none.
/// @param block  into field.blocks, whose own offset does not matter; its mesh_offset is none.
std::vector<OffsetInterval> offset_intervals(const FieldGeometry& field, std::size_t block,
                                             double from, double to);

}  // namespace faultsim
