#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "simulator/common/ranges.h"
#include "simulator/reading/read_keys.h"
#include "simulator/reading/read_scene.h"
#include "simulator/reading/scene_reader.h"
#include "simulator/reading/surface_probes.h"
#include "simulator/scene/offset_intervals.h"

/// What a surface of operators may be over, and where: moduli, Poisson ratios, dips of a field's
/// faults, and offsets.
namespace faultsim {
namespace {

using nlohmann::json;
using Kind = SurfaceParameter::Kind;

/// Of each kind.
constexpr Dimension kDimensions[] = {Dimension::pressure, Dimension::number, Dimension::angle,
                                     Dimension::length};

double end_at(SceneReader& reader, const std::string& pointer, Kind kind) {
  const json* value = reader.find(pointer);
  if (value == nullptr || !reader.sound(pointer)) return kNaN;
  const Dimension dimension = kDimensions[static_cast<int>(kind)];
  if (value->is_number() && dimension == Dimension::number) return value->get<double>();
  const ParsedQuantity parsed = parse_quantity(reader.as_given(pointer), dimension);
  if (!parsed.ok) reader.problem(pointer, parsed.what, parsed.cure);
  return parsed.value;
}

/// Where the operator is analytic and the mesh keeps its topology.
void check_range(SceneReader& reader, const std::string& at, const SurfaceParameter& one,
                 const Scene& scene) {
  constexpr double kMostPoisson = 0.45, kMostDip = 45 * kDegree;
  if (one.from >= one.to)
    reader.problem(at + "/to", "the range is empty", "write a \"to\" above \"from\"");
  if (one.kind == Kind::youngs_modulus && one.from <= 0)
    reader.problem(at + "/from", "a Young's modulus must be above 0", "write a positive one");
  if (one.kind == Kind::poisson_ratio && (one.from < 0 || one.to > kMostPoisson)) {
    reader.problem(at, "a surface in Poisson's ratio is for 0 to 0.45: towards 0.5 it has a pole",
                   "narrow the range");
  }
  if (one.kind == Kind::dip && (one.from < -kMostDip || one.to > kMostDip))
    reader.problem(at, "a dip of a field must be within 45 deg of vertical", "narrow the range");
  if (one.kind == Kind::offset) {
    const Block& block = scene.field.blocks[static_cast<std::size_t>(one.index)];
    if (block.mesh_offset && one.from <= 0 && one.to >= 0) {
      reader.problem(at, "the range contains 0 m, where other cells of the fault's two sides meet",
                     "remove the block's mesh_offset: the range is then taken in intervals");
    }
  }
  const double value = value_of(one, scene);
  constexpr double kRoundingOfEnds = 1e-12;  // relative: ends are written with 15 digits
  const double slack = kRoundingOfEnds * std::max(std::abs(one.from), std::abs(one.to));
  if (value < one.from - slack || value > one.to + slack) {
    reader.problem(at, "the scene's own value lies outside this range",
                   "widen the range, or change the value");
  }
}

/// Whether the offset lies in one of the ranges that a parameter's `exact` lists.
bool is_to_be_exact(SceneReader& reader, std::ptrdiff_t parameter, double offset) {
  const std::string at =
      element("/numerics/surface/over", static_cast<std::size_t>(parameter)) + "/exact";
  for (std::size_t i = 0; i < reader.size(at); ++i) {
    const double from = end_at(reader, element(element(at, i), 0), Kind::offset),
                 to = end_at(reader, element(element(at, i), 1), Kind::offset);
    if (offset >= from && offset <= to) return true;
  }
  return false;
}

/// An offset without a mesh_offset is taken in intervals, each with a layout of grid lines of its
/// own: the scene is on the surface of its interval, or where it has none on an exact operator.
void take_interval(SceneReader& reader, Scene& scene) {
  std::vector<SurfaceParameter>& over = scene.numerics.surface.over;
  const auto is_offset = [](const SurfaceParameter& one) { return one.kind == Kind::offset; };
  const auto joined = std::ranges::find_if(over, [&](const SurfaceParameter& one) {
    return is_offset(one) && !scene.field.blocks[static_cast<std::size_t>(one.index)].mesh_offset;
  });
  if (joined == over.end()) return;
  if (std::ranges::count_if(over, is_offset) > 1) {
    reader.problem("/numerics/surface/over",
                   "the offsets of two blocks cannot be taken in intervals together",
                   "use one of them, or give each block a mesh_offset");
    return;
  }
  const auto block = static_cast<std::size_t>(joined->index);
  const double offset = scene.field.blocks[block].offset;
  const std::vector<OffsetInterval> intervals =
      offset_intervals(scene.field, block, joined->from, joined->to);
  const auto found =
      std::ranges::find_if(intervals, [&](const OffsetInterval& one) { return one.holds(offset); });
  const bool is_next_to_lines = found == intervals.end();
  if (is_next_to_lines || is_to_be_exact(reader, joined - over.begin(), offset)) {
    scene.numerics.surface = {};
    const char* why =
        is_next_to_lines ? " is next to one at which lines of the mesh meet" : " is to be exact";
    scene.remarks.push_back({"/numerics/surface", concat("an offset of ", metres(offset), why,
                                                         ": its operator is not interpolated")});
    return;
  }
  joined->from = found->from;
  joined->to = found->to;
  scene.field.blocks[block].mesh_offset = found->layout;
}

/// Cases put values where the document has a place for them; what they make of the scene is seen
/// when they are run.
void read_probes(SceneReader& reader, const std::vector<std::string>& over, SurfaceProbes& probes) {
  const std::string root = "/numerics/surface/probes";
  read_keys(reader, root + "/", probes);
  const auto cases = surface_probes(reader.document());
  std::set<std::string> replaced(over.begin(), over.end());
  json document = reader.document().value;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const auto& [pointer, value] : cases[i]) {
      const std::string at = element(root + "/cases", i);
      if (contains(over, pointer)) {
        reader.problem(at, "the surface is over " + pointer + ", which the check points choose",
                       "remove it from the case");
      } else if (pointer.starts_with("/numerics/surface")) {
        reader.problem(at, "a case cannot have another surface", "remove " + pointer);
      } else if (replaced.insert(pointer).second) {
        const bool has_place = pointer.starts_with('/') && put_value(document, pointer, value);
        if (has_place) continue;
        reader.problem(at, "the scene has no place for " + pointer,
                       "name a parameter of the scene by its alias or JSON Pointer");
      }
    }
  }
  if (reader.sound(root)) probes.cases = fingerprint_of_probes(reader.document(), replaced);
}

}  // namespace

std::optional<SurfaceParameter> surface_parameter(const std::string& pointer, const Scene& scene) {
  const std::size_t slash = pointer.rfind('/');
  const std::string object = pointer.substr(0, slash), key = pointer.substr(slash + 1);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (object != "/materials/" + pointer_token(scene.materials[i].name)) continue;
    if (key == "youngs_modulus") return SurfaceParameter{Kind::youngs_modulus, static_cast<int>(i)};
    if (key == "poisson_ratio") return SurfaceParameter{Kind::poisson_ratio, static_cast<int>(i)};
  }
  if (scene.geometry_kind != GeometryKind::field) return std::nullopt;
  for (std::size_t i = 0; key == "dip_from_vertical" && i < scene.faults.size(); ++i) {
    if (object == element("/faults", i)) return SurfaceParameter{Kind::dip, static_cast<int>(i)};
  }
  for (std::size_t i = 0; key == "offset" && i < scene.field.blocks.size(); ++i) {
    if (object == element("/geometry/blocks", i))
      return SurfaceParameter{Kind::offset, static_cast<int>(i)};
  }
  return std::nullopt;
}

void read_surface(SceneReader& reader, Scene& scene) {
  const std::string root = "/numerics/surface";
  if (!reader.has(root) || !reader.sound(root)) return;
  SurfaceRequest& surface = scene.numerics.surface;
  read_keys(reader, root + "/", surface);
  std::vector<std::string> pointers;
  for (std::size_t i = 0; i < reader.size(root + "/over"); ++i) {
    const std::string at = element(root + "/over", i);
    std::string pointer = reader.text(at + "/parameter");
    const auto aliases = parameter_aliases(reader.document());
    if (const auto found = aliases.find(pointer); found != aliases.end()) pointer = found->second;
    std::optional<SurfaceParameter> one = surface_parameter(pointer, scene);
    if (!one) {
      reader.problem(at + "/parameter",
                     "no surface can be over " + reader.as_given(at + "/parameter"),
                     "name Young's modulus or Poisson's ratio of a material, the dip of a field's "
                     "fault, or the offset of a block");
      continue;
    }
    one->from = end_at(reader, at + "/from", one->kind);
    one->to = end_at(reader, at + "/to", one->kind);
    const bool twice = std::ranges::any_of(surface.over, [&](const auto& other) {
      return other.kind == one->kind && other.index == one->index;
    });
    if (twice) reader.problem(at, "the parameter is given twice", "remove one");
    if (std::isfinite(one->from) && std::isfinite(one->to)) check_range(reader, at, *one, scene);
    surface.over.push_back(*one);
    pointers.push_back(pointer);
  }
  if (reader.has(root + "/probes")) read_probes(reader, pointers, surface.probes.emplace());
  if (reader.sound("/numerics") && reader.sound("/geometry")) take_interval(reader, scene);
  if (reader.boolean(reader.place(root + "/exact"), false)) surface = {};
}

}  // namespace faultsim
