#include "simulator/corner_point/horizons.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace faultsim::corner_point {
namespace {

/// Columns around a pillar by the side of the faults there: the same number for those that are
/// joined without crossing a barrier. Those outside have −1.
std::array<int, 4> sides_around(const ColumnMap& map, const std::set<int>& barriers, int pillar) {
  const std::array<int, 4> columns = map.columns_around(pillar);
  std::array<int, 4> side;
  for (int c = 0; c < 4; ++c) side[c] = map.is_inside(columns[c]) ? c : -1;
  for (int c = 0; c < 4; ++c) {
    const int next = (c + 1) % 4;
    if (side[c] < 0 || side[next] < 0) continue;
    if (barriers.contains(map.edge_between_columns(columns[c], columns[next]))) continue;
    const int joined = std::min(side[c], side[next]), other = std::max(side[c], side[next]);
    std::ranges::replace(side, other, joined);
  }
  return side;
}

/// Per cell, the compartment of the column's next active cell, upwards first; −1 where there is
/// none. Each column is gone down once.
std::vector<int> next_compartments(const CornerPointGrid& grid, const std::vector<int>& of_cell) {
  std::vector<int> next(of_cell.size(), -1), active;  // active: layers of one column
  for (int column = 0; column < grid.n_columns(); ++column) {
    active.clear();
    for (int k = 0; k < grid.size[2]; ++k) {
      if (of_cell[grid.cell(column, k)] >= 0) active.push_back(k);
    }
    if (active.empty()) continue;
    auto at = active.begin();
    for (int k = 0; k < grid.size[2]; ++k) {
      while (at + 1 != active.end() && *(at + 1) - k < std::abs(*at - k)) ++at;
      next[grid.cell(column, k)] = of_cell[grid.cell(column, *at)];
    }
  }
  return next;
}

class HorizonFinder {
 public:
  HorizonFinder(const ColumnMap& map, const std::set<int>& barriers,
                const std::vector<int>& compartment_of_cell)
      : map_(map), grid_(map.grid()), next_(next_compartments(grid_, compartment_of_cell)) {
    for (int pillar = 0; pillar < map.n_pillars(); ++pillar)
      sides_.push_back(sides_around(map, barriers, pillar));
  }

  Horizon surface(int k, bool is_base) const {
    Horizon horizon{.layer = k, .is_base = is_base};
    for (int pillar = 0; pillar < map_.n_pillars(); ++pillar) add_points(pillar, horizon);
    return horizon;
  }

  double largest_gap_below(int k) const {
    double largest = 0;
    for (int column = 0; column < grid_.n_columns(); ++column) {
      if (compartment_at(column, k) < 0) continue;
      for (const CornerPlace& top : kTopCorners) {
        const double bottom = grid_.z(column, k, {top.right, top.back, true});
        largest = std::max(largest, std::abs(bottom - grid_.z(column, k + 1, top)));
      }
    }
    return largest;
  }

 private:
  /// Of a column in a layer; −1: the column has no active cell.
  int compartment_at(int column, int k) const { return next_[grid_.cell(column, k)]; }

  /// Corners of columns on one side that are of one compartment.
  struct Group {
    int side = -1, compartment = -1, n = 0;
    double sum = 0, low = 0, high = 0;

    void add(double z) {
      low = n == 0 ? z : std::min(low, z);
      high = n == 0 ? z : std::max(high, z);
      sum += z;
      n += 1;
    }
  };

  void add_points(int pillar, Horizon& horizon) const {
    const std::array<int, 4> columns = map_.columns_around(pillar);
    std::array<Group, 4> groups;  // those behind the last are empty
    for (int c = 0; c < 4; ++c) {
      const int side = sides_[pillar][c];
      const int compartment = side < 0 ? -1 : compartment_at(columns[c], horizon.layer);
      if (compartment < 0) continue;
      Group& group = *std::ranges::find_if(groups, [&](const Group& of) {
        return of.n == 0 || (of.side == side && of.compartment == compartment);
      });
      group.side = side;
      group.compartment = compartment;
      CornerPlace corner = map_.corner_at(columns[c], pillar);
      corner.bottom = horizon.is_base;
      group.add(grid_.z(columns[c], horizon.layer, corner));
    }
    for (const Group& group : groups) {
      if (group.n == 0) break;
      const double mean = group.sum / group.n;
      horizon.largest_step = std::max(horizon.largest_step, group.high - group.low);
      const Eigen::Vector2d at = grid_.pillars[pillar].at(mean);
      horizon.points.push_back({{at.x(), at.y(), mean}, pillar, group.compartment});
    }
  }

  const ColumnMap& map_;
  const CornerPointGrid& grid_;
  std::vector<int> next_;                  ///< per cell, next_compartments().
  std::vector<std::array<int, 4>> sides_;  ///< per pillar.
};

}  // namespace

Horizons find_horizons(const ColumnMap& map, const std::set<int>& barriers,
                       const std::vector<int>& compartment_of_cell, double gap) {
  const HorizonFinder finder(map, barriers, compartment_of_cell);
  Horizons found;
  const int n_layers = map.grid().size[2];
  for (int k = 0; k < n_layers; ++k) {
    found.all.push_back(finder.surface(k, false));
    const double below = k + 1 < n_layers ? finder.largest_gap_below(k) : 0;
    found.largest_gap = std::max(found.largest_gap, below);
    if (k + 1 == n_layers || below > gap) found.all.push_back(finder.surface(k, true));
  }
  return found;
}

std::vector<Layer> find_layers(const ColumnMap& map, double no_thickness) {
  const CornerPointGrid& grid = map.grid();
  std::vector<char> is_active_column;
  for (int column = 0; column < grid.n_columns(); ++column)
    is_active_column.push_back(grid.has_active_cell(column) ? 1 : 0);
  std::vector<Layer> layers;
  for (int k = 0; k < grid.size[2]; ++k) {
    Layer layer{.is_collapsed = true};
    for (int column = 0; column < grid.n_columns(); ++column) {
      const bool is_thin = grid.largest_thickness(column, k) < no_thickness;
      layer.n_collapsed += is_thin ? 1 : 0;
      if (is_active_column[column] == 0) continue;
      layer.is_collapsed = layer.is_collapsed && is_thin;
      const bool is_active = grid.is_active[grid.cell(column, k)] != 0;
      (is_active ? layer.n_active : layer.n_inactive) += 1;
      if (is_active) layer.thickness += grid.thickness(column, k);
    }
    if (layer.n_active > 0) layer.thickness /= layer.n_active;
    layers.push_back(layer);
  }
  return layers;
}

}  // namespace faultsim::corner_point
