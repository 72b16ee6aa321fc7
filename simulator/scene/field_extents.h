#pragma once

#include <cstddef>
#include <string>

#include "simulator/flow/flow_field.h"
#include "simulator/scene/geometry.h"

/// Where the blocks and faults of a field begin and end along strike.
namespace faultsim {

struct Scene;

/// m, of y.
struct StrikeInterval {
  double from = 0, to = 0;
  bool holds(double y) const { return y > from && y < to; }
  double length() const { return to - from; }
};

/// Shorter than this nothing can be meshed, m.
inline constexpr double kLeastExtent = 1e-3;

/// Of a block: its own ends, else those of block_length.
StrikeInterval block_ends(const FieldGeometry& field, const Block& block);

/// Of a fault: its own ends, else those of fault_length. At the ends of the model they are cut.
StrikeInterval fault_ends(const FieldGeometry& field, std::size_t fault);

/// Whether y lies between the ends of a block; plane strain takes blocks as endless.
bool reaches(const Scene& scene, std::size_t block, double y);

/// Corners of a hexahedron that is symmetric about y = 0 (between_sides), moved along y to the ends
/// of a block.
CellCorners within_ends(CellCorners corners, const StrikeInterval& ends);

/// The first block or fault that is not its own mirror image at y = 0, in words: "block east
/// reaches from y = -500 m to 1200 m"; "" where all are.
std::string asymmetric_extent(const Scene& scene);

}  // namespace faultsim
