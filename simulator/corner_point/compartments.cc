#include "simulator/corner_point/compartments.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "simulator/common/disjoint_sets.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/flow/cell_overlap.h"

namespace faultsim::corner_point {
namespace {

/// Numbers of sets of columns that hang together and no fault separates; one a column.
std::vector<int> parts_of_map(const ColumnMap& map, const std::set<int>& barriers) {
  const CornerPointGrid& grid = map.grid();
  DisjointSets sets(static_cast<std::size_t>(grid.n_columns()));
  for (int column = 0; column < grid.n_columns(); ++column) {
    const std::array<int, 2> at = grid.place(column);
    const std::array<int, 2> next = {at[0] + 1 < grid.size[0] ? column + 1 : -1,
                                     at[1] + 1 < grid.size[1] ? column + grid.size[0] : -1};
    for (const int other : next) {
      if (!map.is_inside(column) || !map.is_inside(other)) continue;
      if (!barriers.contains(map.edge_between_columns(column, other))) sets.join(column, other);
    }
  }
  return sets.numbered();
}

double volume_of(const CornerPointGrid& grid, int column, int k) {
  CellCorners corners;  // VTK: the bottom, then the top, each in turn
  for (std::size_t c = 0; c < 8; ++c) {
    const bool right = c % 4 == 1 || c % 4 == 2, back = c % 4 >= 2;
    corners[c] = grid.corner(column, k, {right, back, c < 4});
  }
  return flow_cell_volume(flow_cell_around(corners));
}

/// Top or bottom of a cell: its area on the map, m2, and its mean height, m.
struct FaceOnMap {
  double area = 0, height = 0;
};

FaceOnMap face_of(const CornerPointGrid& grid, int column, int k, bool bottom) {
  const auto at = [&](bool right, bool back) {
    return grid.corner(column, k, {right, back, bottom});
  };
  const Eigen::Vector3d a = at(false, false), b = at(true, false), c = at(true, true),
                        d = at(false, true);
  const double area = std::abs(cross_product((c - a).head<2>(), (d - b).head<2>())) / 2;
  return {area, (a.z() + b.z() + c.z() + d.z()) / 4};
}

/// Adds what a column's cells of a compartment (from top to base) say.
void add_column(const CornerPointGrid& grid, int column, int top, int base, Compartment& into) {
  const FaceOnMap upper = face_of(grid, column, top, false),
                  lower = face_of(grid, column, base, true);
  into.n_columns += 1;
  into.area += upper.area;
  into.mean_top += upper.area * upper.height;
  into.mean_base += upper.area * lower.height;
}

/// Areas and volumes, and means over the area.
void measure(const CornerPointGrid& grid, Compartment& compartment) {
  std::map<int, std::array<int, 2>> layers;  // uppermost and lowest, by column
  for (const int cell : compartment.cells) {
    const int column = cell % grid.n_columns(), k = cell / grid.n_columns();
    compartment.volume += volume_of(grid, column, k);
    layers.try_emplace(column, std::array<int, 2>{k, k}).first->second[1] = k;  // k ascends
  }
  for (const auto& [column, of] : layers) add_column(grid, column, of[0], of[1], compartment);
  if (compartment.area == 0) return;
  compartment.mean_top /= compartment.area;
  compartment.mean_base /= compartment.area;
}

}  // namespace

Compartments find_compartments(const ColumnMap& map, const std::set<int>& barriers,
                               CompartmentRule rule) {
  const CornerPointGrid& grid = map.grid();
  const std::vector<int> parts =
      rule == CompartmentRule::faults ? parts_of_map(map, barriers) : std::vector<int>{};
  std::map<int, Compartment> by_number;
  for (int cell = 0; cell < grid.n_cells(); ++cell) {
    if (grid.is_active[cell] == 0) continue;
    const int number = rule == CompartmentRule::faults ? parts[cell % grid.n_columns()]
                       : rule == CompartmentRule::equilibrium_regions
                           ? grid.equilibrium_region[cell]
                           : grid.fluid_region[cell];
    by_number[number].cells.push_back(cell);
    by_number[number].region = number;
  }
  Compartments found;
  for (auto& [number, compartment] : by_number) {
    measure(grid, compartment);
    found.all.push_back(std::move(compartment));
  }
  if (rule == CompartmentRule::faults) {
    std::ranges::stable_sort(found.all, std::ranges::greater(), &Compartment::volume);
    for (std::size_t c = 0; c < found.all.size(); ++c)
      found.all[c].region = static_cast<int>(c) + 1;
  }
  found.of_cell.assign(grid.is_active.size(), -1);
  for (std::size_t c = 0; c < found.all.size(); ++c) {
    for (const int cell : found.all[c].cells) found.of_cell[cell] = static_cast<int>(c);
  }
  return found;
}

}  // namespace faultsim::corner_point
