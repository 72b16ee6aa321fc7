#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/mesh/box_layout.h"
#include "simulator/mesh/mesh_spec.h"
#include "simulator/mesh/structured_grid.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;

void place_points(const BoxLayout& layout, StructuredGrid& grid) {
  const size_t a = layout.axis, b = layout.column_axis, c = layout.row_axis;
  grid.position.resize(grid.n_points());
  std::vector<double> shifts(grid.n_lines(a), 0.0);
  for (size_t m = 0; m < grid.n_lines(c); ++m)
    for (size_t n = 0; n < grid.n_lines(b); ++n) {
      Vector3d place = Vector3d::Zero();
      const auto set = [&](size_t axis, double x) { place[static_cast<Eigen::Index>(axis)] = x; };
      set(c, grid.lines[c][m]);
      set(b, grid.lines[b][n]);
      if (layout.column_shear)
        set(b, grid.lines[b][n] + layout.column_shear->shift(grid.lines[b][n], grid.lines[c][m]));
      if (layout.shear) {
        const size_t first = std::min(b, c), second = std::max(b, c);
        layout.shear->shifts(grid.lines[a], place[static_cast<Eigen::Index>(first)],
                             place[static_cast<Eigen::Index>(second)], shifts);
      }
      std::array<size_t, 3> at{};
      at[b] = n;
      at[c] = m;
      for (at[a] = 0; at[a] < grid.n_lines(a); ++at[a]) {
        set(a, grid.lines[a][at[a]] + shifts[at[a]]);
        grid.position[grid.point(at)] = place;
      }
    }
}

void fill_cells(const BoxMeshSpec& spec, StructuredGrid& grid) {
  const size_t per_layer = (grid.n_lines(0) - 1) * (grid.n_lines(1) - 1);
  for (size_t k = 0; k + 1 < grid.n_lines(2); ++k) {
    const double middle = 0.5 * (grid.lines[2][k] + grid.lines[2][k + 1]);
    size_t layer = 0;
    while (layer + 1 < spec.layers.size() && middle < -spec.layers[layer + 1].top_depth) ++layer;
    grid.material.insert(grid.material.end(), per_layer, spec.layer_materials[layer]);
  }
  CellRegions regions = cell_regions(spec, grid.lines);
  grid.region = std::move(regions.region);
  grid.region_fraction = std::move(regions.fraction);
}

GridFault box_fault(const BoxMeshSpec& spec, const BoxLayout& layout, const StructuredGrid& grid,
                    size_t patch) {
  const PatchFrame& frame = layout.frames[patch];
  GridFault fault;
  fault.name = spec.fault_names[patch];
  fault.axis = layout.axis;
  fault.column_axis = layout.column_axis;
  fault.row_axis = layout.row_axis;
  fault.normal = frame.normal;
  fault.strike = frame.strike;
  fault.dip = frame.dip;
  const double tolerance = edge_tolerance(spec);
  const std::vector<double>& across = grid.lines[fault.axis];
  const double ref = layout.shear->planes()[layout.plane_of[patch]].ref;
  fault.plane =
      static_cast<size_t>(std::ranges::lower_bound(across, ref - tolerance) - across.begin());
  std::array<size_t, 3> at{};
  at[fault.axis] = fault.plane;
  for (at[fault.column_axis] = 0; at[fault.column_axis] < grid.n_lines(fault.column_axis);
       ++at[fault.column_axis])
    for (at[fault.row_axis] = 0; at[fault.row_axis] < grid.n_lines(fault.row_axis);
         ++at[fault.row_axis])
      fault.split.push_back(
          frame.inside(grid.position[grid.point(at)], tolerance, !spec.plane_strain) ? 1 : 0);
  return fault;
}

}  // namespace

GridLines grid_lines(const BoxMeshSpec& spec, std::vector<Problem>& problems) {
  std::vector<Problem> found;
  GridLines lines = box_layout(spec, found).lines;
  if (found.empty()) found = grid_size_problems(lines);
  problems.insert(problems.end(), found.begin(), found.end());
  return found.empty() ? lines : GridLines{};
}

Mesh make_mesh(const BoxMeshSpec& spec) {
  std::vector<Problem> problems;
  BoxLayout layout = box_layout(spec, problems);
  StructuredGrid grid;
  grid.lines = std::move(layout.lines);
  if (problems.empty()) problems = grid_size_problems(grid.lines);
  if (!problems.empty()) throw InputError("scene", problems);
  grid.tied = spec.tied;
  grid.plane_strain = spec.plane_strain;
  place_points(layout, grid);
  fill_cells(spec, grid);
  for (size_t i = 0; i < spec.patches.size(); ++i)
    grid.faults.push_back(box_fault(spec, layout, grid, i));
  Mesh mesh = cut_faults(std::move(grid));
  refuse_bad_cells(mesh);
  return mesh;
}

}  // namespace faultsim
