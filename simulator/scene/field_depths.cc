#include "simulator/scene/field_depths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faultsim {

bool DepthInterval::holds(double depth, DepthSide side) const {
  const bool inside = depth > top && depth < bottom;
  return inside || (depth == top && side == DepthSide::below) ||
         (depth == bottom && side == DepthSide::above);
}

void DepthInterval::unite(const DepthInterval& other) {
  top = std::min(top, other.top);
  bottom = std::max(bottom, other.bottom);
}

DepthInterval reservoir_range(const FieldGeometry& field) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < field.layers.size(); ++i) {
    if (field.layers[i].name != field.reservoir_layer) continue;
    const bool is_last = i + 1 == field.layers.size();
    return {field.layers[i].top_depth, is_last ? field.depth : field.layers[i + 1].top_depth};
  }
  return {kNone, kNone};
}

DepthInterval reservoir_range(const FieldGeometry& field, const Block& block) {
  const DepthInterval layer = reservoir_range(field);
  const double top = layer.top + block.offset;
  return {top, block.thickness ? top + *block.thickness : layer.bottom + block.offset};
}

std::span<const Block> blocks_beside(const FieldGeometry& field, std::size_t fault) {
  const std::size_t first = fault == 0 ? 0 : fault - 1;
  return std::span(field.blocks).subspan(first, std::min(fault + 1, field.blocks.size()) - first);
}

DepthInterval fault_range(const FieldGeometry& field, std::size_t fault) {
  DepthInterval range{HUGE_VAL, -HUGE_VAL};
  for (const Block& block : blocks_beside(field, fault)) range.unite(reservoir_range(field, block));
  return {range.top - field.fault_overshoot, range.bottom + field.fault_overshoot};
}

double fault_x(const Scene& scene, std::size_t fault, double depth) {
  const auto& blocks = scene.field.blocks;
  const double x = fault < blocks.size() ? blocks[fault].from : blocks.back().to;
  return x + (depth - scene.field.pivot_depth) * std::tan(scene.faults[fault].dip_from_vertical);
}

}  // namespace faultsim
