#include "simulator/scene/field_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "simulator/flow/flow_mapping.h"
#include "simulator/scene/field_extents.h"
#include "simulator/scene/scene.h"

namespace faultsim {
namespace {

/// Lines of a mesh that are closer are one, and it has the depth of either.
bool is_same_depth(double a, double b) {
  constexpr double kSameLine = 1e-6;  // m
  return std::abs(a - b) <= kSameLine;
}

}  // namespace

bool DepthInterval::holds(double depth, DepthSide side) const {
  const bool inside = depth > top && depth < bottom;
  return inside || (depth == top && side == DepthSide::below) ||
         (depth == bottom && side == DepthSide::above);
}

DepthSide DepthInterval::inner_side(double depth) const {
  if (is_same_depth(depth, top)) return DepthSide::below;
  return is_same_depth(depth, bottom) ? DepthSide::above : DepthSide::mean;
}

void DepthInterval::unite(const DepthInterval& other) {
  top = std::min(top, other.top);
  bottom = std::max(bottom, other.bottom);
}

std::size_t reservoir_index(const FieldGeometry& field) {
  const auto found = std::ranges::find(field.layers, field.reservoir_layer, &Layer::name);
  return static_cast<std::size_t>(found - field.layers.begin());
}

DepthInterval reservoir_range(const FieldGeometry& field) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::size_t i = reservoir_index(field), n = field.layers.size();
  if (i == n) return {kNone, kNone};
  return {field.layers[i].top_depth, i + 1 == n ? field.depth : field.layers[i + 1].top_depth};
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

double overshoot_of(const FieldGeometry& field, std::size_t fault) {
  if (fault >= field.fault_extents.size()) return field.fault_overshoot;
  return field.fault_extents[fault].overshoot.value_or(field.fault_overshoot);
}

bool has_own_overshoot(const FieldGeometry& field, std::size_t fault) {
  return fault < field.fault_extents.size() && field.fault_extents[fault].overshoot.has_value();
}

double common_overshoot(const FieldGeometry& field, std::size_t block) {
  const bool are_own = has_own_overshoot(field, block) && has_own_overshoot(field, block + 1);
  return are_own ? 0 : field.fault_overshoot;
}

DepthInterval fault_range(const FieldGeometry& field, std::size_t fault) {
  DepthInterval range{HUGE_VAL, -HUGE_VAL};
  for (const Block& block : blocks_beside(field, fault)) range.unite(reservoir_range(field, block));
  const double overshoot = overshoot_of(field, fault);
  return {range.top - overshoot, range.bottom + overshoot};
}

DepthInterval all_faults_range(const FieldGeometry& field) {
  DepthInterval all = fault_range(field, 0);
  for (std::size_t i = 1; i <= field.blocks.size(); ++i) all.unite(fault_range(field, i));
  return all;
}

std::vector<double> line_depths(const FieldGeometry& field) {
  std::vector<double> depths = {field.depth, 0};
  for (const Layer& layer : field.layers) depths.push_back(layer.top_depth);
  for (const Block& block : field.blocks) {
    const DepthInterval range = reservoir_range(field, block);
    depths.insert(depths.end(), {range.top, range.bottom});
  }
  for (std::size_t i = 0; i <= field.blocks.size(); ++i) {
    const DepthInterval range = fault_range(field, i);
    depths.insert(depths.end(), {range.top, range.bottom});
  }
  return depths;
}

double fault_x(const FieldGeometry& field, std::size_t fault) {
  return fault < field.blocks.size() ? field.blocks[fault].from : field.blocks.back().to;
}

CellCorners block_corners(const Scene& scene, std::size_t block) {
  const DepthInterval depths = reservoir_range(scene.field, scene.field.blocks[block]);
  const auto x_of = [&](std::size_t fault) {
    return std::array{fault_x(scene, fault, depths.top), fault_x(scene, fault, depths.bottom)};
  };
  return within_ends(between_sides(x_of(block), x_of(block + 1), depths.top, depths.bottom, 1),
                     block_ends(scene.field, scene.field.blocks[block]));
}

double fault_x(const Scene& scene, std::size_t fault, double depth) {
  return fault_x(scene.field, fault) +
         (depth - scene.field.pivot_depth) * std::tan(scene.faults[fault].dip_from_vertical);
}

}  // namespace faultsim
