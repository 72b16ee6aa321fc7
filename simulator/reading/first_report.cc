#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/flow/flow_mapping.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/field_depths.h"

/// Initial pressures of blocks from the first report of a flow result.
namespace faultsim {
namespace {

constexpr const char* kFrom = "/initial_state/pressure_from";

/// Middle of the part of a flow cell that lies at a reservoir's depths, m.
double depth_within(const FlowCell& cell, const DepthInterval& reservoir) {
  return 0.5 *
         (std::max(-cell.high.z(), reservoir.top) + std::min(-cell.low.z(), reservoir.bottom));
}

/// What else says the same pressures is refused.
void refuse_given(SceneReader& reader, const Scene& scene) {
  const std::string what =
      "contradicts the initial pressures that pressure_from takes from the "
      "flow result";
  for (std::size_t b = 0; b < scene.field.blocks.size(); ++b) {
    if (scene.field.blocks[b].overpressure)
      reader.problem(element("/geometry/blocks", b) + "/overpressure", what,
                     "remove one of the two");
  }
  if (scene.initial.overpressure != 0)
    reader.problem("/initial_state/overpressure", what, "remove one of the two");
}

/// The reservoirs of all blocks; in plane strain their sections.
std::vector<MappedCell> reservoirs(const Scene& scene) {
  std::vector<MappedCell> bodies;
  for (std::size_t b = 0; b < scene.field.blocks.size(); ++b) {
    CellCorners corners = block_corners(scene, b);
    if (scene.numerics.plane_strain == Switch::on)
      corners = at_section(corners, scene.pressure_field.y);
    bodies.push_back({.corners = corners, .region = static_cast<int>(b)});
  }
  return bodies;
}

/// Mean over what is covered of a block of p - p0 at the reference, Pa.
double mean_excess(const Scene& scene, const FlowField& there, const FlowMapping& mapping,
                   std::size_t block) {
  const DepthInterval reservoir = reservoir_range(scene.field, scene.field.blocks[block]);
  double excess = 0;
  for (const FlowMapping::Weight& one : mapping.weights[block]) {
    const double depth =
        depth_within(there.cells[static_cast<std::size_t>(one.flow_cell)], reservoir);
    excess += one.value * (there.value(one.flow_cell, scene.pressure_field.reference) -
                           initial_region_pressure(scene, block, depth));
  }
  return excess;
}

}  // namespace

void take_first_report(SceneReader& reader, Scene& scene) {
  const bool wanted = scene.initial.pressure_from == InitialPressure::first_report &&
                      scene.pressure_field.is_given();
  const auto is_sound = [&] {
    return reader.sound("/geometry") && reader.sound("/initial_state") && reader.sound("/faults") &&
           reader.sound("/pressure_field");
  };
  if (!wanted || !is_sound()) return;
  if (scene.geometry_kind != GeometryKind::field) {
    return reader.problem(kFrom, "takes the pressures of the blocks of a field, but there is none",
                          "give \"initial_state\" the pressures of the report");
  }
  refuse_given(reader, scene);
  if (!is_sound()) return;
  const std::shared_ptr<const FlowField> there = field_in_scene(scene.pressure_field);
  FlowMapping mapping;
  try {
    mapping = map_flow(*there, reservoirs(scene), region_names(scene),
                       {.outside = OutsideRule::unchanged});
  } catch (const InputError& error) {
    for (const Problem& one : error.problems())
      reader.problem("/pressure_field", one.what, one.cure);
    return;
  }
  std::vector<double> excess;
  double sum = 0, volume = 0;
  for (std::size_t b = 0; b < scene.field.blocks.size(); ++b) {
    if (mapping.weights[b].empty()) {
      reader.problem(kFrom, "the flow result covers no part of " + scene.field.blocks[b].name,
                     "check \"origin\" and \"azimuth\" of the field and its units, or give the "
                     "blocks their \"overpressure\"");
      continue;
    }
    excess.push_back(mean_excess(scene, *there, mapping, b));
    sum += mapping.coverage[b].volume * excess.back();
    volume += mapping.coverage[b].volume;
  }
  if (excess.size() < scene.field.blocks.size()) return;
  for (std::size_t b = 0; b < excess.size(); ++b) scene.field.blocks[b].overpressure = excess[b];
  if (scene.initial.kind == InitialStressKind::column) scene.initial.overpressure = sum / volume;
}

}  // namespace faultsim
