#include "simulator/case_figures/field_section.h"

#include <algorithm>
#include <cmath>

namespace faultsim {
namespace {

struct Reach {
  double top = 0, base = 0;  ///< m, depth.
};

/// The reservoir layer at zero offset.
Reach reservoir_of(const FieldGeometry& field) {
  for (std::size_t k = 0; k < field.layers.size(); ++k) {
    if (field.layers[k].name != field.reservoir_layer) continue;
    return {field.layers[k].top_depth,
            k + 1 < field.layers.size() ? field.layers[k + 1].top_depth : field.depth};
  }
  return {0, field.depth};
}

Reach reach_of(const Scene& scene, std::size_t fault) {
  Reach reach{scene.field.depth, 0};
  for (const figure::DepthBand& band : compartments_beside(scene, fault)) {
    reach.top = std::min(reach.top, band.top - scene.field.fault_overshoot);
    reach.base = std::max(reach.base, band.base + scene.field.fault_overshoot);
  }
  return {std::max(reach.top, 0.0), std::min(reach.base, scene.field.depth)};
}

}  // namespace

std::vector<figure::DepthBand> compartments_beside(const Scene& scene, std::size_t fault) {
  if (scene.geometry_kind != GeometryKind::field) return {};
  const Reach reservoir = reservoir_of(scene.field);
  std::vector<figure::DepthBand> bands;
  const auto add = [&](const Block& block, bool plus) {
    bands.push_back(
        {block.name, reservoir.top + block.offset, reservoir.base + block.offset, plus});
  };
  const std::vector<Block>& blocks = scene.field.blocks;
  if (fault > 0 && fault - 1 < blocks.size()) add(blocks[fault - 1], false);
  if (fault < blocks.size()) add(blocks[fault], true);
  return bands;
}

double fault_place(const Scene& scene, std::size_t fault, double depth) {
  const std::vector<Block>& blocks = scene.field.blocks;
  const double x = fault < blocks.size() ? blocks[fault].from : blocks.back().to;
  return x + std::tan(scene.faults[fault].dip_from_vertical) * (depth - scene.field.pivot_depth);
}

figure::Section field_section(const Scene& scene) {
  const FieldGeometry& field = scene.field;
  const Reach reservoir = reservoir_of(field);
  figure::Section section;
  double shallowest = field.depth, deepest = 0;
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    const Reach reach = reach_of(scene, f);
    shallowest = std::min(shallowest, reach.top);
    deepest = std::max(deepest, reach.base);
    section.faults.push_back({scene.faults[f].name,
                              {{fault_place(scene, f, reach.top), reach.top},
                               {fault_place(scene, f, reach.base), reach.base}},
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
    const double top = reservoir.top + field.blocks[b].offset;
    const double base = reservoir.base + field.blocks[b].offset;
    section.rocks.push_back({.name = field.blocks[b].name,
                             .from = fault_place(scene, b, top),
                             .to = fault_place(scene, b + 1, top),
                             .from_base = fault_place(scene, b, base),
                             .to_base = fault_place(scene, b + 1, base),
                             .top = top,
                             .base = base,
                             .is_reservoir = true});
  }
  return section;
}

}  // namespace faultsim
