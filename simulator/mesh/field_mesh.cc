#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/mesh/grading.h"
#include "simulator/mesh/mesh_spec.h"
#include "simulator/mesh/shear.h"
#include "simulator/mesh/structured_grid.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"
#include "simulator/scene/offset_intervals.h"

namespace faultsim {
namespace {

constexpr double kMaxDip = 0.7854;       // 45 degrees, rounded up
constexpr double kSameLine = 1e-6;       // m
constexpr double kEdgeTolerance = 1e-5;  // m; ten times the distance below which lines are merged
constexpr double kLeastRest = 0.1;       // of a cell; a thinner rest is spread over its neighbours
constexpr int kEdgeCells = 2;  // cells of exactly sizes.dip on each side of a reservoir edge

void check_sizes(const FieldMeshSpec& spec, std::vector<Problem>& problems) {
  const double most = 1e6;  // lines per axis
  if (spec.depth / (spec.sizes.grades_corners() ? spec.sizes.corner : spec.sizes.dip) > most ||
      spec.width / spec.sizes.normal > most ||
      (!spec.plane_strain && spec.length / spec.sizes.strike > most))
    problems.push_back({"/mesh", 0, "cells are a millionth of the model", "use larger cells"});
  for (size_t i = 0; i < spec.blocks.size(); ++i) {
    if (spec.blocks[i].to - spec.blocks[i].from > 2 * kEdgeTolerance) continue;
    problems.push_back({concat("/geometry/blocks/", i, "/to"), 0, "is not east of `from`",
                        "give a block some width"});
  }
}

/// Where faults end in depth: by fault_overshoot beside blocks, which offsets move, or by their
/// own.
void check_fault_ends(const FieldMeshSpec& spec, std::vector<Problem>& problems) {
  const auto check = [&](const DepthInterval& range, const std::string& pointer,
                         const char* to_lower, const char* to_raise) {
    if (!(range.top > 0))
      problems.push_back({pointer, 0, "puts the top of a fault at or above the surface", to_lower});
    if (!(range.bottom < spec.depth))
      problems.push_back({pointer, 0,
                          concat("puts the foot of a fault at ", range.bottom,
                                 " m, at or below the base of the model"),
                          to_raise});
  };
  for (size_t i = 0; i < spec.blocks.size(); ++i) {
    const DepthInterval range = reservoir_range(spec, spec.blocks[i]);
    const double overshoot = common_overshoot(spec, i);
    check({range.top - overshoot, range.bottom + overshoot},
          concat("/geometry/blocks/", i, "/offset"),
          "use a larger offset or a smaller fault_overshoot",
          "use a smaller offset or fault_overshoot, or a deeper model");
  }
  for (size_t f = 0; f <= spec.blocks.size(); ++f) {
    if (has_own_overshoot(spec, f))
      check(fault_range(spec, f), concat("/faults/", f, "/overshoot"), "use a smaller overshoot",
            "use a smaller overshoot or a deeper model");
  }
}

void check_faults(const FieldMeshSpec& spec, std::vector<Problem>& problems) {
  check_fault_ends(spec, problems);
  for (size_t i = 0; i < spec.fault_dips.size(); ++i)
    if (!(std::abs(spec.fault_dips[i]) <= kMaxDip))
      problems.push_back({concat("/faults/", i, "/dip_from_vertical"), 0, "is more than 45 deg",
                          "use a steeper fault"});
}

/// Grid lines x bent onto the faults: x_i + (depth − pivot) tan(dip), straight beyond the tips.
Shear field_shear(const FieldMeshSpec& spec) {
  std::vector<BentPlane> planes;
  for (size_t i = 0; i <= spec.blocks.size(); ++i) {
    const DepthInterval range = fault_range(spec, i);
    const double margin = kShearMargin * spec.sizes.dip;
    BentPlane plane;
    plane.ref = fault_x(spec, i);
    plane.slope = {0, -std::tan(spec.fault_dips[i])};
    plane.pivot = {0, -spec.pivot_depth};
    plane.low = {0, -range.bottom - margin};
    plane.high = {0, -range.top + margin};
    planes.push_back(plane);
  }
  return Shear(-0.5 * spec.width, 0.5 * spec.width, std::move(planes));
}

void check_shear(const FieldMeshSpec& spec, std::vector<Problem>& problems) {
  const int gap = field_shear(spec).first_squeezed_gap({0, 0}, {-spec.depth, 0});
  if (gap < 0) return;
  const size_t fault = std::min(static_cast<size_t>(gap), spec.blocks.size());
  const bool side = gap == 0 || static_cast<size_t>(gap) > spec.blocks.size();
  const std::string other =
      side ? "the side of the model" : concat("fault \"", spec.fault_names[fault - 1], "\"");
  problems.push_back(
      {concat("/faults/", fault, "/dip_from_vertical"), 0,
       concat("brings fault \"", spec.fault_names[fault], "\" to or too near ", other),
       "use a smaller dip, or move them apart"});
}

std::vector<double> field_x(const FieldMeshSpec& spec) {
  LineBuilder builder(-0.5 * spec.width, 0.5 * spec.width, spec.sizes.growth, spec.sizes.largest);
  for (size_t i = 0; i <= spec.blocks.size(); ++i)
    builder.add_line(fault_x(spec, i), spec.sizes.normal);
  return builder.build();
}

std::vector<double> field_y(const FieldMeshSpec& spec) {
  if (spec.plane_strain) return {0, 1};
  const double half = 0.5 * spec.length;
  LineBuilder builder(spec.half_domain ? 0 : -half, half, spec.sizes.growth, spec.sizes.largest);
  // A line at y = 0 in the full domain too, so that the half domain is half of its grid.
  builder.add_line(0);
  for (const Block& block : spec.blocks) {
    const StrikeInterval ends = block_ends(spec, block);
    builder.add_line(ends.from);
    builder.add_line(ends.to);
  }
  for (size_t i = 0; i <= spec.blocks.size(); ++i) {
    const StrikeInterval ends = fault_ends(spec, i);
    builder.add_window(ends.from, ends.to, spec.sizes.strike);
  }
  return builder.build();
}

/// Depths that must be grid lines as z, in the order of line_depths().
std::vector<double> special_z(const FieldMeshSpec& spec) {
  return mapped(line_depths(spec), [](double depth) { return -depth; });
}

/// Those depths, ascending, each once.
std::vector<double> must_lines(const FieldMeshSpec& spec) {
  std::vector<double> z = special_z(spec);
  std::ranges::sort(z);
  const auto same = [](double a, double b) { return b - a < kSameLine; };
  drop_repeated(z, same);
  return z;
}

bool is_reservoir_edge(const FieldMeshSpec& spec, double z) {
  return std::any_of(spec.blocks.begin(), spec.blocks.end(), [&](const Block& block) {
    const DepthInterval range = reservoir_range(spec, block);
    return std::abs(z + range.top) < kEdgeTolerance || std::abs(z + range.bottom) < kEdgeTolerance;
  });
}

/// Cells of sizes.corner at the reservoir edges, which carry logarithmic stress peaks, growing to
/// sizes.dip between them: the same heights at the edges in all members of an offset sweep. Two
/// edges that leave no room for that are evenly divided between.
std::vector<double> graded_fault_range(const FieldMeshSpec& spec, const DepthInterval& range) {
  LineBuilder builder(-range.bottom, -range.top, spec.sizes.corner_growth, spec.sizes.dip);
  for (const double z : must_lines(spec)) {
    if (is_reservoir_edge(spec, z))
      builder.add_line(z, spec.sizes.corner);
    else
      builder.add_line(z);
  }
  return builder.build();
}

/// Without graded corners: cells are sizes.dip high in all
/// members of an offset sweep: kEdgeCells of exactly that height on both sides of each reservoir
/// edge. Where two lines leave no room for that, or would leave a rest thinner than kLeastRest of
/// a cell, the gap between them is divided evenly. The rest of the faults' range has cells of about
/// sizes.dip, divided evenly from line to line; beyond it cells grow.
std::vector<double> field_z(const FieldMeshSpec& spec) {
  LineBuilder builder(-spec.depth, 0, spec.sizes.growth, spec.sizes.largest);
  const double dip = spec.sizes.dip, edge_height = kEdgeCells * dip;
  const std::vector<double> z = must_lines(spec);
  const DepthInterval all = all_faults_range(spec);
  if (spec.sizes.grades_corners()) {
    for (const double must : z) builder.add_line(must);
    for (const double line : graded_fault_range(spec, all)) builder.add_line(line);
    builder.add_window(-all.bottom, -all.top, 2 * dip);  // a cell from line to line
    return builder.build();
  }
  for (size_t i = 0; i + 1 < z.size(); ++i) {
    builder.add_line(z[i]);
    const bool low = is_reservoir_edge(spec, z[i]), high = is_reservoir_edge(spec, z[i + 1]);
    const double rest = z[i + 1] - z[i] - edge_height * (low + high);
    const bool fits = std::abs(rest) < kEdgeTolerance || rest >= kLeastRest * dip;
    if (!fits) continue;
    if (low) builder.add_window(z[i], z[i] + edge_height, dip);
    if (high) builder.add_window(z[i + 1] - edge_height, z[i + 1], dip);
  }
  builder.add_window(-all.bottom, -all.top, dip);
  return builder.build();
}

FieldMeshSpec with_mesh_offsets(FieldMeshSpec spec) {
  for (Block& block : spec.blocks) block.offset = block.mesh_offset.value_or(block.offset);
  return spec;
}

/// A special depth where lines were laid out, and where it belongs.
struct MovedDepth {
  double from, to;
};

/// Special depths of the layout, ascending, each once. Empty when their order is another at the
/// blocks' offsets, or a gap changes too much.
std::vector<MovedDepth> moved_depths(const FieldMeshSpec& spec) {
  const std::vector<double> from = special_z(with_mesh_offsets(spec)), to = special_z(spec);
  std::vector<MovedDepth> all, kept;
  for (size_t i = 0; i < from.size(); ++i) all.push_back({from[i], to[i]});
  std::ranges::sort(all, {}, &MovedDepth::from);
  for (const MovedDepth& one : all) {
    if (!kept.empty() && one.from - kept.back().from < kSameLine) {
      if (std::abs(one.to - kept.back().to) >= kSameLine) return {};
      continue;
    }
    const double stretch =
        kept.empty() ? 1 : (one.to - kept.back().to) / (one.from - kept.back().from);
    if (!(stretch >= kLeastStretch && stretch <= kLargestStretch)) return {};
    kept.push_back(one);
  }
  return kept;
}

bool moves_lines(const FieldMeshSpec& spec) {
  return std::ranges::any_of(spec.blocks,
                             [](const Block& block) { return block.mesh_offset.has_value(); });
}

void check_moved_lines(const FieldMeshSpec& spec, std::vector<Problem>& problems) {
  if (!moves_lines(spec) || !moved_depths(spec).empty()) return;
  for (size_t i = 0; i < spec.blocks.size(); ++i) {
    const Block& block = spec.blocks[i];
    if (!block.mesh_offset) continue;
    problems.push_back({concat("/geometry/blocks/", i, "/mesh_offset"), 0,
                        concat("grid lines laid out for an offset of ", *block.mesh_offset,
                               " m cannot be moved to ", block.offset,
                               " m: reservoir edges, layers or fault tips would meet, change order "
                               "or come much closer"),
                        "use a mesh_offset nearer to offset, on the same side of 0 m and of the "
                        "reservoir's thickness"});
  }
}

/// Lines laid out for the mesh offsets, moved to the offsets.
std::vector<double> moved_z(const FieldMeshSpec& spec) {
  if (!moves_lines(spec)) return field_z(spec);
  std::vector<double> lines = field_z(with_mesh_offsets(spec));
  const std::vector<MovedDepth> depths = moved_depths(spec);
  size_t gap = 0;
  for (double& z : lines) {
    while (gap + 2 < depths.size() && z > depths[gap + 1].from) ++gap;
    const MovedDepth &low = depths[gap], &high = depths[gap + 1];
    const double at = z - low.from, length = high.from - low.from;
    if (length - at < kSameLine) {
      z = high.to;
      continue;
    }
    const double s = at / length, shift = low.to - low.from;
    z = low.to + at + ((high.to - high.from) - shift) * s * s * (3 - 2 * s);
  }
  return lines;
}

/// Material and region of a reference place.
struct CellKind {
  int material;
  int region;
};

CellKind kind_at(const FieldMeshSpec& spec, double x, double y, double depth) {
  const auto above = [](double at, const Layer& layer) { return at < layer.top_depth; };
  const size_t layer = static_cast<size_t>(
      std::upper_bound(spec.layers.begin() + 1, spec.layers.end(), depth, above) -
      spec.layers.begin() - 1);
  const auto block = std::ranges::find_if(
      spec.blocks, [&](const auto& one) { return x > one.from && x < one.to; });
  const size_t reservoir = reservoir_index(spec);
  const bool beside =
      block == spec.blocks.end() || (!spec.plane_strain && !block_ends(spec, *block).holds(y));
  if (beside)
    return {layer == reservoir ? spec.sideburden_material : spec.layer_materials[layer], -1};
  const DepthInterval range = reservoir_range(spec, *block), unmoved = reservoir_range(spec);
  if (depth > range.top && depth < range.bottom)
    return {spec.layer_materials[reservoir], static_cast<int>(block - spec.blocks.begin())};
  // What the block left behind: the layer above follows it down, the layer below follows it up.
  if (depth < range.top && depth > unmoved.top) return {spec.layer_materials[reservoir - 1], -1};
  if (depth > range.bottom && depth < unmoved.bottom)
    return {spec.layer_materials[reservoir + 1], -1};
  return {spec.layer_materials[layer], -1};
}

void fill_cells(const FieldMeshSpec& spec, StructuredGrid& grid) {
  const auto middle = [&](size_t axis, size_t n) {
    return 0.5 * (grid.lines[axis][n] + grid.lines[axis][n + 1]);
  };
  for (size_t k = 0; k + 1 < grid.n_lines(2); ++k)
    for (size_t j = 0; j + 1 < grid.n_lines(1); ++j)
      for (size_t i = 0; i + 1 < grid.n_lines(0); ++i) {
        const CellKind kind = kind_at(spec, middle(0, i), middle(1, j), -middle(2, k));
        grid.material.push_back(kind.material);
        grid.region.push_back(kind.region);
        grid.region_fraction.push_back(kind.region >= 0 ? 1 : 0);
      }
}

void place_points(const FieldMeshSpec& spec, StructuredGrid& grid) {
  const Shear shear = field_shear(spec);
  grid.position.resize(grid.n_points());
  std::vector<double> shifts;
  for (size_t k = 0; k < grid.n_lines(2); ++k) {
    shear.shifts(grid.lines[0], 0, grid.lines[2][k], shifts);
    for (size_t j = 0; j < grid.n_lines(1); ++j)
      for (size_t i = 0; i < grid.n_lines(0); ++i)
        grid.position[grid.point({i, j, k})] = {grid.lines[0][i] + shifts[i], grid.lines[1][j],
                                                grid.lines[2][k]};
  }
}

GridFault field_fault(const FieldMeshSpec& spec, const StructuredGrid& grid, size_t i) {
  GridFault fault;
  fault.name = spec.fault_names[i];
  const double dip = spec.fault_dips[i];
  fault.normal = {std::cos(dip), 0, std::sin(dip)};
  fault.dip = {std::sin(dip), 0, -std::cos(dip)};
  fault.strike = {0, -1, 0};  // dip = n × strike
  const std::vector<double>& x = grid.lines[0];
  fault.plane = static_cast<size_t>(
      std::lower_bound(x.begin(), x.end(), fault_x(spec, i) - kEdgeTolerance) - x.begin());
  const DepthInterval range = fault_range(spec, i);
  const StrikeInterval ends = fault_ends(spec, i);
  // An end at that of the model is none: the model's end cuts the fault.
  const bool south = ends.from > -0.5 * (spec.length - kEdgeTolerance),
             north = ends.to < 0.5 * (spec.length - kEdgeTolerance);
  for (const double y : grid.lines[1])
    for (const double z : grid.lines[2]) {
      const bool in_length = spec.plane_strain || ((!south || y > ends.from + kEdgeTolerance) &&
                                                   (!north || y < ends.to - kEdgeTolerance));
      const bool in_depth = -z > range.top + kEdgeTolerance && -z < range.bottom - kEdgeTolerance;
      fault.split.push_back(in_length && in_depth ? 1 : 0);
    }
  return fault;
}

StructuredGrid make_grid(const FieldMeshSpec& spec) {
  std::vector<Problem> problems;
  StructuredGrid grid;
  grid.lines = grid_lines(spec, problems);
  if (!problems.empty()) throw InputError("scene", problems);
  grid.plane_strain = spec.plane_strain;
  place_points(spec, grid);
  fill_cells(spec, grid);
  for (size_t i = 0; i <= spec.blocks.size(); ++i)
    grid.faults.push_back(field_fault(spec, grid, i));
  return grid;
}

}  // namespace

GridLines grid_lines(const FieldMeshSpec& spec, std::vector<Problem>& problems) {
  std::vector<Problem> found;
  check_sizes(spec, found);
  if (found.empty()) check_faults(spec, found);
  if (found.empty()) check_shear(spec, found);
  if (found.empty()) check_moved_lines(spec, found);
  GridLines lines;
  if (found.empty()) {
    try {
      lines = {field_x(spec), field_y(spec), moved_z(spec)};
      found = grid_size_problems(lines);
    } catch (const InputError& error) {  // too many on an axis
      found = error.problems();
    }
  }
  problems.insert(problems.end(), found.begin(), found.end());
  return found.empty() ? lines : GridLines{};
}

Mesh make_mesh(const FieldMeshSpec& spec) {
  Mesh mesh = cut_faults(make_grid(spec));
  refuse_bad_cells(mesh);
  return mesh;
}

std::optional<Mesh> make_faults(const FieldMeshSpec& spec, const Mesh& like) {
  return cut_as(like, make_grid(spec));
}

}  // namespace faultsim
