#include "simulator/plan/planned_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "simulator/plan/body_mesh.h"
#include "simulator/scene/field_depths.h"
#include "simulator/scene/field_extents.h"

namespace faultsim {
namespace {

/// Lines strictly between two coordinates, as a range [first, second).
std::pair<int, int> lines_between(const std::vector<double>& lines, double from, double to) {
  const auto first = std::ranges::upper_bound(lines, from + 1e-6);
  const auto last = std::lower_bound(first, lines.end(), to - 1e-6);
  return {static_cast<int>(first - lines.begin()), static_cast<int>(last - lines.begin())};
}

/// The line at a coordinate, or next to it: where a fault lies on the grid before it is sheared.
std::pair<int, int> line_at(const std::vector<double>& lines, double at) {
  const auto first = std::ranges::lower_bound(lines, at - 1e-6);
  const int line =
      std::min(static_cast<int>(first - lines.begin()), static_cast<int>(lines.size()) - 1);
  return {line, line + 1};
}

std::vector<FaultWindow> field_faults(const Scene& scene, const Plan& plan,
                                      const GridLines& lines) {
  const FieldGeometry& field = scene.field;
  const double end = field.length / 2;  // there the model cuts a fault
  std::vector<FaultWindow> faults;
  for (std::size_t f = 0; f <= field.blocks.size(); ++f) {
    const DepthInterval range = fault_range(field, f);
    const StrikeInterval along = fault_ends(field, f);
    const auto columns =
        plan.plane_strain ? std::pair{0, 1}
                          : lines_between(lines[1], along.from > -end ? along.from : -field.length,
                                          along.to < end ? along.to : field.length);
    faults.push_back({{line_at(lines[0], fault_x(field, f)), columns,
                       lines_between(lines[2], -range.bottom, -range.top)}});
  }
  return faults;
}

/// A patch covers the grid plane nearest to its own, from edge to edge.
FaultWindow box_fault(const PatchGeometry& patch, const Plan& plan, const GridLines& lines) {
  constexpr double kQuarter = 0.78539816339744831;  // pi/4
  const bool is_flat = patch.dip_from_vertical > kQuarter || patch.dip_from_vertical < -kQuarter;
  const bool strikes_along_x = std::abs(std::sin(patch.strike)) > std::abs(std::cos(patch.strike));
  const std::size_t column_axis = strikes_along_x ? 0 : 1;
  const std::size_t row_axis = is_flat ? 1 - column_axis : 2;
  const std::size_t axis = 3 - column_axis - row_axis;
  const double dip = patch.dip_from_vertical;
  const double along = strikes_along_x ? std::sin(patch.strike) : std::cos(patch.strike);
  std::array<double, 3> half{};
  half[column_axis] = patch.length / 2 * std::abs(along);
  half[row_axis] = patch.width / 2 * std::abs(is_flat ? std::sin(dip) : std::cos(dip));
  FaultWindow w;
  for (std::size_t a = 0; a < 3; ++a) {
    w.lines[a] =
        a == axis ? line_at(lines[a], patch.center[a])
                  : lines_between(lines[a], patch.center[a] - half[a], patch.center[a] + half[a]);
  }
  if (plan.plane_strain) w.lines[1] = {0, 1};
  if (patch.shape == PatchShape::ellipse && !plan.plane_strain) w.share = kQuarter;
  return w;
}

GridLines lines_of(const Scene& scene, const Plan& plan, std::vector<Problem>& problems) {
  const bool is_field = scene.geometry_kind == GeometryKind::field;
  return is_field ? grid_lines(field_mesh_spec(scene, plan), problems)
                  : grid_lines(box_mesh_spec(scene, plan), problems);
}

/// Unit loads, and components of observation points.
int n_loads(const Scene& scene) {
  return static_cast<int>(scene.pressure.size() + scene.box.boundary.size() +
                          3 * scene.output.observation_points.size());
}

GridShape grid_shape(const Scene& scene, const Plan& plan, const GridLines& lines) {
  GridShape shape;
  const int n_y = plan.plane_strain ? 1 : static_cast<int>(lines[1].size());
  shape.n_lines = {static_cast<int>(lines[0].size()), n_y, static_cast<int>(lines[2].size())};
  shape.unknowns_per_node = plan.plane_strain ? 2 : 3;
  shape.n_loads = n_loads(scene);
  if (scene.geometry_kind == GeometryKind::field) {
    shape.faults = field_faults(scene, plan, lines);
  } else {
    for (const PatchGeometry& patch : scene.box.patches) {
      shape.faults.push_back(box_fault(patch, plan, lines));
    }
  }
  return shape;
}

/// Intervals between lines whose middle lies between two coordinates.
double intervals(const std::vector<double>& lines, double from, double to) {
  int n = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double middle = 0.5 * (lines[i - 1] + lines[i]);
    n += middle > from && middle < to;
  }
  return n;
}

/// About how many cells lie in pressure regions, from the lines of the grid before it is sheared
/// and shifted: what a field of pressures or temperatures has an influence of.
double reservoir_cells(const Scene& scene, const GridLines& lines, bool plane_strain) {
  const auto box = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
    const double along = plane_strain ? 1 : intervals(lines[1], y0, y1);
    return intervals(lines[0], x0, x1) * along * intervals(lines[2], z0, z1);
  };
  double n = 0;
  if (scene.geometry_kind == GeometryKind::field) {
    for (const Block& block : scene.field.blocks) {
      const DepthInterval range = reservoir_range(scene.field, block);
      const StrikeInterval ends = block_ends(scene.field, block);
      n += box(block.from, block.to, ends.from, ends.to, -range.bottom, -range.top);
    }
    return n;
  }
  for (const PressureRegion& region : scene.box.regions) {
    constexpr double kDiscOfSquare = 0.785;  // pi/4
    const auto [low, high] = bounds_of(region);
    n += (region.shape == RegionShape::disc ? kDiscOfSquare : 1) *
         box(low[0], high[0], low[1], high[1], low[2], high[2]);
  }
  return n;
}

/// The program, and the build of the last operator beside what the others keep.
PlannedGrid grid_of_mesh(const Scene& scene) {
  const BodyMesh& file = *scene.box.mesh;
  const auto is_loaded = [&](int group) { return !file.volumes[group].compartment.empty(); };
  PlannedGrid grid{shape_of_mesh(scene), std::ssize(file.content->cell_group),
                   static_cast<double>(std::ranges::count_if(file.content->cell_group, is_loaded))};
  grid.shape.n_loads = n_loads(scene);
  return grid;
}

}  // namespace

std::optional<PlannedGrid> planned_grid(const Scene& scene, const Plan& plan,
                                        std::vector<Problem>& problems) {
  if (is_meshed(scene)) return grid_of_mesh(scene);
  const GridLines lines = lines_of(scene, plan, problems);
  if (std::ranges::any_of(lines, [](const auto& line) { return line.size() < 2; }))
    return std::nullopt;
  return PlannedGrid{
      grid_shape(scene, plan, lines),
      static_cast<long>((lines[0].size() - 1) * (lines[1].size() - 1) * (lines[2].size() - 1)),
      reservoir_cells(scene, lines, plan.plane_strain)};
}

}  // namespace faultsim
