#include "simulator/case_figures/field_section.h"

#include <algorithm>

namespace faultsim {
namespace {

DepthInterval reach_of(const Scene& scene, std::size_t fault) {
  const DepthInterval range = fault_range(scene.field, fault);
  return {std::max(range.top, 0.0), std::min(range.bottom, scene.field.depth)};
}

}  // namespace

std::vector<figure::DepthBand> compartments_beside(const Scene& scene, std::size_t fault) {
  if (scene.geometry_kind != GeometryKind::field) return {};
  std::vector<figure::DepthBand> bands;
  const auto add = [&](const Block& block, bool plus) {
    const DepthInterval reservoir = reservoir_range(scene.field, block);
    bands.push_back({block.name, reservoir.top, reservoir.bottom, plus});
  };
  const std::vector<Block>& blocks = scene.field.blocks;
  if (fault > 0 && fault - 1 < blocks.size()) add(blocks[fault - 1], false);
  if (fault < blocks.size()) add(blocks[fault], true);
  return bands;
}

figure::Section field_section(const Scene& scene) {
  const FieldGeometry& field = scene.field;
  figure::Section section;
  double shallowest = field.depth, deepest = 0;
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    const DepthInterval reach = reach_of(scene, f);
    shallowest = std::min(shallowest, reach.top);
    deepest = std::max(deepest, reach.bottom);
    section.faults.push_back({scene.faults[f].name,
                              {{fault_x(scene, f, reach.top), reach.top},
                               {fault_x(scene, f, reach.bottom), reach.bottom}},
                              {}});
  }
  const double width = field.blocks.back().to - field.blocks.front().from;
  section.from = std::max(-field.width / 2, field.blocks.front().from - 0.2 * width);
  section.to = std::min(field.width / 2, field.blocks.back().to + 0.2 * width);
  const double margin = std::max(0.4 * (deepest - shallowest), 0.03 * width);
  section.top = std::max(0.0, shallowest - margin);
  section.base = std::min(field.depth, deepest + margin);
  for (std::size_t k = 0; k < field.layers.size(); ++k) {
    const Layer& layer = field.layers[k];
    const double base = k + 1 < field.layers.size() ? field.layers[k + 1].top_depth : field.depth;
    const bool is_reservoir = layer.name == field.reservoir_layer;
    section.rocks.push_back({.name = is_reservoir ? field.sideburden : layer.name,
                             .from = -field.width / 2,
                             .to = field.width / 2,
                             .from_base = -field.width / 2,
                             .to_base = field.width / 2,
                             .top = layer.top_depth,
                             .base = base});
  }
  for (std::size_t b = 0; b < field.blocks.size(); ++b) {
    const auto [top, base] = reservoir_range(field, field.blocks[b]);
    section.rocks.push_back({.name = field.blocks[b].name,
                             .from = fault_x(scene, b, top),
                             .to = fault_x(scene, b + 1, top),
                             .from_base = fault_x(scene, b, base),
                             .to_base = fault_x(scene, b + 1, base),
                             .top = top,
                             .base = base,
                             .is_reservoir = true});
  }
  return section;
}

}  // namespace faultsim
