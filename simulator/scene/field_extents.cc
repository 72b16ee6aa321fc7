#include "simulator/scene/field_extents.h"

#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/scene/scene.h"

namespace faultsim {
namespace {

std::string reach_text(const StrikeInterval& ends) {
  return concat(" reaches from y = ", ends.from, " m to ", ends.to, " m");
}

bool is_symmetric(const StrikeInterval& ends) {
  constexpr double kSame = 1e-6;  // m, as of lines of the grid
  return std::abs(ends.from + ends.to) <= kSame;
}

}  // namespace

StrikeInterval block_ends(const FieldGeometry& field, const Block& block) {
  const double half = 0.5 * field.block_length;
  return {block.y_from.value_or(-half), block.y_to.value_or(half)};
}

StrikeInterval fault_ends(const FieldGeometry& field, std::size_t fault) {
  const double half = 0.5 * field.fault_length;
  if (fault >= field.fault_extents.size()) return {-half, half};
  const FaultExtent& own = field.fault_extents[fault];
  return {own.y_from.value_or(-half), own.y_to.value_or(half)};
}

bool reaches(const Scene& scene, std::size_t block, double y) {
  return scene.numerics.plane_strain == Switch::on ||
         block_ends(scene.field, scene.field.blocks[block]).holds(y);
}

CellCorners within_ends(CellCorners corners, const StrikeInterval& ends) {
  for (auto& corner : corners) corner.y() = corner.y() > 0 ? ends.to : ends.from;
  return corners;
}

std::string asymmetric_extent(const Scene& scene) {
  const FieldGeometry& field = scene.field;
  for (const Block& block : field.blocks) {
    const StrikeInterval ends = block_ends(field, block);
    if (!is_symmetric(ends)) return concat("block ", block.name, reach_text(ends));
  }
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    const StrikeInterval ends = fault_ends(field, f);
    if (!is_symmetric(ends)) return concat("fault ", scene.faults[f].name, reach_text(ends));
  }
  return "";
}

}  // namespace faultsim
