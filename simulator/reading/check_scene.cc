#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "simulator/initial_state/load_times.h"
#include "simulator/reading/field_ends.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/scene/field_depths.h"

/// Checks that relate parts of a scene. NaN marks what was reported before and fails no check.
namespace faultsim {
namespace {

void check_field_extent(SceneReader& reader, const FieldGeometry& field) {
  const std::string at = "/geometry/";
  for (const auto& [key, value] : {std::pair("block_length", field.block_length),
                                   std::pair("fault_length", field.fault_length)}) {
    if (value > field.length) {
      reader.problem(at + key,
                     reader.as_given(at + key) + " is more than the model's length, " +
                         reader.as_given(at + "length"),
                     "make it shorter or the model longer");
    }
  }
  if (!field.layers.empty()) {
    if (std::abs(field.layers.front().top_depth) > 0) {
      reader.problem(at + "layers/0/top", "the first layer does not begin at the surface",
                     "write \"0 m\"");
    }
    if (field.layers.back().top_depth >= field.depth) {
      reader.problem(
          concat(at, "layers/", field.layers.size() - 1, "/top"),
          "the layer begins below the base of the model, " + reader.as_given(at + "depth"),
          "make \"depth\" larger");
    }
  }
  for (std::size_t i = 0; i < field.blocks.size(); ++i) {
    for (const auto& [key, x] :
         {std::pair("from", field.blocks[i].from), std::pair("to", field.blocks[i].to)}) {
      if (std::abs(x) < 0.5 * field.width || std::isnan(x) || std::isnan(field.width)) continue;
      const std::string pointer = element(at + "blocks", i) + "/" + key;
      reader.problem(pointer,
                     reader.as_given(pointer) + " is not inside the model, x = " +
                         metres(-0.5 * field.width) + " to " + metres(0.5 * field.width),
                     "make \"width\" larger");
    }
    check_field_ends(reader, element(at + "blocks", i) + "/", field);
  }
}

void check_offsets(SceneReader& reader, const FieldGeometry& field) {
  for (std::size_t i = 0; i < field.blocks.size(); ++i) {
    const Block& block = field.blocks[i];
    const double margin = common_overshoot(field, i);
    const DepthInterval reservoir = reservoir_range(field, block);
    const double top = reservoir.top - margin;
    const double bottom = reservoir.bottom + margin;
    if (!(top <= 0) && !(bottom >= field.depth)) continue;
    const bool has_offset = block.offset != 0;
    reader.problem(
        concat("/geometry/blocks/", i, has_offset ? "/offset" : ""),
        "the reservoir of \"" + block.name + "\" with its faults reaches from " + metres(top) +
            " to " + metres(bottom) + " depth, outside the model",
        "keep it between 0 m and " + metres(field.depth) + ": " +
            (has_offset ? "an offset above " + metres(margin - reservoir.top + block.offset) +
                              " and below " +
                              metres(field.depth - margin - reservoir.bottom + block.offset)
                        : "a smaller fault_overshoot or a larger depth"));
  }
}

/// Faults with an overshoot of their own, beside reservoirs that lie within the model.
void check_own_overshoots(SceneReader& reader, const Scene& scene) {
  const FieldGeometry& field = scene.field;
  for (std::size_t f = 0; f < scene.faults.size() && f <= field.blocks.size(); ++f) {
    if (!has_own_overshoot(field, f) || field.blocks.empty()) continue;
    const double own = overshoot_of(field, f);
    const DepthInterval range = fault_range(field, f);
    const double most = std::min(range.top + own, field.depth - range.bottom + own);
    if (!(own >= most) || !(most > 0)) continue;
    const std::string pointer = element("/faults", f) + "/overshoot";
    reader.problem(pointer,
                   "the fault \"" + scene.faults[f].name + "\" reaches from " + metres(range.top) +
                       " to " + metres(range.bottom) + " depth, outside the model",
                   "keep it between 0 m and " + metres(field.depth) + ": an overshoot below " +
                       metres(most) + ", or a larger depth");
  }
}

/// Dipping faults may not meet between the highest and the lowest point of any.
void check_crossing(SceneReader& reader, const Scene& scene) {
  const FieldGeometry& field = scene.field;
  if (scene.faults.size() != field.blocks.size() + 1 || field.blocks.empty()) return;
  DepthInterval all = reservoir_range(field);
  for (const Block& block : field.blocks) all.unite(reservoir_range(field, block));
  double overshoot = 0;
  for (std::size_t f = 0; f < scene.faults.size(); ++f)
    overshoot = std::max(overshoot, overshoot_of(field, f));
  for (const double depth : {all.top - overshoot, all.bottom + overshoot}) {
    for (std::size_t i = 0; i < scene.faults.size(); ++i) {
      const std::string pointer = element("/faults", i) + "/dip_from_vertical";
      const double x = fault_x(scene, i, depth);
      if (std::abs(x) >= 0.5 * field.width) {
        reader.problem(pointer,
                       "fault \"" + scene.faults[i].name + "\" leaves the model at " +
                           metres(depth) + " depth",
                       "use a smaller dip or a larger width");
      }
      if (i > 0 && x <= fault_x(scene, i - 1, depth)) {
        reader.problem(pointer,
                       "fault \"" + scene.faults[i].name + "\" meets \"" +
                           scene.faults[i - 1].name + "\" at " + metres(depth) + " depth",
                       "use smaller dips or a wider block");
      }
    }
  }
}

void check_layer_tops(SceneReader& reader, const BoxGeometry& box) {
  if (box.layers.empty()) return;
  if (std::abs(box.layers.front().top_depth + box.to[2]) > 1e-9 * std::abs(box.to[2])) {
    reader.problem("/geometry/layers/0/top", "the first layer does not begin at the top of the box",
                   "write \"" + metres(-box.to[2]) + "\"");
  }
  if (-box.layers.back().top_depth <= box.from[2]) {
    reader.problem(concat("/geometry/layers/", box.layers.size() - 1, "/top"),
                   "the layer begins below the base of the box, " + metres(-box.from[2]) + " depth",
                   "write a smaller depth");
  }
}

void check_box(SceneReader& reader, const Scene& scene) {
  const BoxGeometry& box = scene.box;
  static const char* const axes = "xyz";
  for (std::size_t k = 0; k < 3; ++k) {
    if (box.to[k] <= box.from[k]) {
      reader.problem(element("/geometry/to", k),
                     std::string("the box ends before it begins along ") + axes[k],
                     "write the upper corner in \"to\"");
    }
    for (std::size_t i = 0; i < box.patches.size(); ++i) {
      const Bounds bounds = bounds_of(box.patches[i]);
      if (bounds.low[k] >= box.to[k] || bounds.high[k] <= box.from[k]) {
        reader.problem(
            element("/faults", i) + "/center",
            "fault \"" + scene.faults[i].name + "\" lies outside the box along " + axes[k],
            "move its centre between " + metres(box.from[k]) + " and " + metres(box.to[k]));
      }
    }
    for (std::size_t i = 0; i < box.regions.size(); ++i) {
      const Bounds bounds = bounds_of(box.regions[i]);
      const double from = bounds.low[k], to = bounds.high[k];
      const std::string at = element("/geometry/regions", i);
      if (to <= from) {
        reader.problem(concat(at, "/to/", k),
                       std::string("the region ends before it begins along ") + axes[k],
                       "write the upper corner in \"to\"");
      } else if (from >= box.to[k] || to <= box.from[k]) {
        reader.problem(
            at, "region \"" + box.regions[i].name + "\" lies outside the box along " + axes[k],
            "move it between " + metres(box.from[k]) + " and " + metres(box.to[k]));
      }
    }
  }
  check_layer_tops(reader, box);
}

void check_column(SceneReader& reader, const Scene& scene) {
  if (!reader.sound("/initial_state")) return;
  if (is_meshed(scene) && scene.initial.viscous_layers == ViscousLayers::lithostatic) {
    reader.problem("/initial_state/viscous_layers", "a mesh has no layers to be lithostatic in",
                   "use \"ratios\"");
  }
  if (scene.initial.kind != InitialStressKind::column) return;
  if (is_meshed(scene)) {
    reader.problem("/initial_state/kind", "a mesh has no layers that a column could weigh",
                   "use \"kind\": \"profile\" or \"tensor\"");
    return;
  }
  if (scene.geometry_kind == GeometryKind::box) {
    if (std::abs(scene.box.to[2]) > 0) {
      reader.problem(
          "/initial_state/kind",
          "a column needs the top of the box at z = 0, but it is at " + metres(scene.box.to[2]),
          "use \"kind\": \"profile\", or move the box");
    }
    if (std::abs(scene.initial.overpressure) > 0) {
      reader.problem("/initial_state/overpressure", "a box has no reservoir layer to hold it",
                     "use \"kind\": \"profile\" with \"pressure\"");
    }
  }
  for (const Material& material : used_materials(scene)) {
    const std::string at = "/materials/" + pointer_token(material.name);
    if (!reader.has(at + "/density")) {
      reader.problem(at, "\"density\" is missing: the initial column needs it",
                     "add for example \"density\": \"2400 kg/m3\"");
    }
  }
}

/// Stiffnesses this far apart leave no digits of the softer one in a sum of both.
void check_contrast(SceneReader& reader, const Scene& scene) {
  constexpr double kMost = 1e10;
  std::vector<Material> used = used_materials(scene);
  std::erase_if(used, [](const Material& one) { return std::isnan(one.youngs_modulus); });
  if (used.empty()) return;
  const auto softest = std::ranges::min_element(used, {}, &Material::youngs_modulus);
  const auto stiffest = std::ranges::max_element(used, {}, &Material::youngs_modulus);
  if (stiffest->youngs_modulus <= kMost * softest->youngs_modulus) return;
  const std::string at = "/materials/" + pointer_token(softest->name) + "/youngs_modulus";
  reader.problem(
      at,
      reader.as_given(at) + " is less than 1e-10 of that of \"" + stiffest->name + "\", " +
          reader.as_given("/materials/" + pointer_token(stiffest->name) + "/youngs_modulus"),
      "bring the two closer: double precision cannot resolve both");
}

void check_observation_points(SceneReader& reader, const Scene& scene) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  const FieldGeometry& field = scene.field;
  const std::array<double, 3> field_from = {-0.5 * field.width, -0.5 * field.length, -field.depth};
  const std::array<double, 3> field_to = {0.5 * field.width, 0.5 * field.length, 0};
  const auto& from = is_field ? field_from : scene.box.from;
  const auto& to = is_field ? field_to : scene.box.to;
  for (std::size_t i = 0; i < scene.output.observation_points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = scene.output.observation_points[i].position[k];
      if (!(x < from[k]) && !(x > to[k])) continue;
      const std::string pointer =
          element(element("/output/observation_points", i) + "/position", k);
      reader.problem(pointer, reader.as_given(pointer) + " is outside the model",
                     std::string("write a value from ") + metres(from[k]) + " to " + metres(to[k]) +
                         (k == 2 ? " (z grows upwards)" : ""));
    }
  }
}

}  // namespace

void check_turning_points(SceneReader& reader, const Scene& scene) {
  if (!reader.sound("/stages") || !reader.sound("/numerics")) return;
  const std::vector<StepEnd> steps = step_ends(scene);
  const auto n_added = std::ranges::count_if(steps, [](const StepEnd& step) { return step.added; });
  if (n_added <= scene.numerics.max_added_steps) return;
  const auto first = std::ranges::find_if(steps, [](const StepEnd& step) { return step.added; });
  const bool given = reader.has("/numerics/max_added_steps");
  reader.problem(
      given ? "/numerics/max_added_steps" : "/stages",
      concat("the loads turn at ", n_added, " times between load steps, first at ",
             in_unit(first->time, Dimension::time, "year"), "; steps are added for at most ",
             scene.numerics.max_added_steps),
      "choose load steps that end there, raise /numerics/max_added_steps, or skip them with "
      "\"turning_points\": \"report\" in /numerics");
}

void check_geometry(SceneReader& reader, const Scene& scene) {
  if (!reader.sound("/geometry/kind") || !reader.has("/geometry/kind")) return;
  if (is_of_mesh(reader) && !is_meshed(scene)) return;
  if (!reader.sound("/geometry/file") || !reader.sound("/geometry/volumes")) return;
  if (scene.geometry_kind == GeometryKind::field) {
    check_field_extent(reader, scene.field);
    for (std::size_t i = 0; i < scene.faults.size(); ++i)
      check_field_ends(reader, element("/faults", i) + "/", scene.field);
    check_offsets(reader, scene.field);
    check_own_overshoots(reader, scene);
    check_crossing(reader, scene);
  } else if (!is_meshed(scene)) {
    check_box(reader, scene);
  }
  check_contrast(reader, scene);
  check_column(reader, scene);
  check_observation_points(reader, scene);
}

}  // namespace faultsim
