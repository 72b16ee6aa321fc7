#include "simulator/corner_point/column_map.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace faultsim::corner_point {

namespace {

/// The uppermost and the lowest layer of a column with an active cell; none: the first is greater.
std::array<int, 2> active_layers(const CornerPointGrid& grid, int column) {
  std::array<int, 2> layers = {0, grid.size[2] - 1};
  const auto is_active = [&](int k) { return grid.is_active[grid.cell(column, k)] != 0; };
  while (layers[0] <= layers[1] && !is_active(layers[0])) ++layers[0];
  while (layers[0] <= layers[1] && !is_active(layers[1])) --layers[1];
  return layers;
}

/// The lowest and the highest corner of a column between two layers, m.
std::array<double, 2> heights_of(const CornerPointGrid& grid, int column,
                                 const std::array<int, 2>& layers) {
  std::array<double, 2> heights = {HUGE_VAL, -HUGE_VAL};
  for (const CornerPlace& top : kTopCorners) {
    heights[0] = std::min(heights[0], grid.z(column, layers[1], {top.right, top.back, true}));
    heights[1] = std::max(heights[1], grid.z(column, layers[0], top));
  }
  return heights;
}

/// Of a cell's top on the map, negative where i and j are left-handed. Of its corners: the points
/// by which a file gives pillars may lie where pillars that fan have crossed.
double doubled_area_of(const CornerPointGrid& grid, int column, int layer) {
  const auto corner = [&](bool right, bool back) {
    return Eigen::Vector2d(grid.corner(column, layer, {right, back, false}).head<2>());
  };
  const Eigen::Vector2d across = corner(true, true) - corner(false, false),
                        other = corner(false, true) - corner(true, false);
  return across.x() * other.y() - across.y() * other.x();
}

bool has_inverted_cell(const CornerPointGrid& grid, int column, const std::array<int, 2>& layers) {
  for (int k = layers[0]; k <= layers[1]; ++k)
    if (grid.is_inverted(column, k)) return true;
  return false;
}

}  // namespace

ColumnMap::ColumnMap(const CornerPointGrid& grid) : grid_(&grid) {
  double doubled_area = 0;
  for (int column = 0; column < grid.n_columns(); ++column) {
    layers_.push_back(active_layers(grid, column));
    is_inside_.push_back(layers_.back()[0] <= layers_.back()[1] ? 1 : 0);
    if (is_inside_.back() == 0) continue;
    doubled_area += doubled_area_of(grid, column, layers_.back()[0]);
  }
  is_left_handed_ = doubled_area < 0;
  take_in_holes();
}

std::vector<int> ColumnMap::columns_beside(int column) const {
  const auto [i, j] = grid_->place(column);
  std::vector<int> all;
  for (const int other : {column_or_none(i - 1, j), column_or_none(i + 1, j),
                          column_or_none(i, j - 1), column_or_none(i, j + 1)})
    if (other >= 0) all.push_back(other);
  return all;
}

void ColumnMap::take_in_holes() {
  constexpr std::size_t kMost = 8;  // what an outline takes in
  constexpr std::size_t kSides = 4;
  std::vector<char> is_seen = is_inside_;
  for (int begin = 0; begin < grid_->n_columns(); ++begin) {
    if (is_seen[begin] != 0) continue;
    std::vector<int> hole = {begin}, around;
    is_seen[begin] = 1;
    bool is_enclosed = true;
    for (std::size_t next = 0; next < hole.size(); ++next) {
      const std::vector<int> beside = columns_beside(hole[next]);
      is_enclosed = is_enclosed && beside.size() == kSides;
      for (const int other : beside) {
        if (is_inside_[other] != 0) {
          around.push_back(other);
        } else if (is_seen[other] == 0) {
          is_seen[other] = 1;
          hole.push_back(other);
        }
      }
    }
    if (is_enclosed && hole.size() <= kMost) take_in(hole, around);
  }
}

/// If its cells lie where those around it do, give or take their height: inactive ones may be
/// anywhere.
void ColumnMap::take_in(const std::vector<int>& hole, const std::vector<int>& around) {
  std::array<int, 2> layers = layers_[around.front()];
  for (const int column : around) {
    layers[0] = std::min(layers[0], layers_[column][0]);
    layers[1] = std::max(layers[1], layers_[column][1]);
  }
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const int column : around) {
    const std::array<double, 2> heights = heights_of(*grid_, column, layers_[column]);
    low = std::min(low, heights[0]);
    high = std::max(high, heights[1]);
  }
  const double give = high - low;
  const bool is_rock = std::ranges::all_of(hole, [&](int column) {
    const std::array<double, 2> heights = heights_of(*grid_, column, layers);
    return heights[0] >= low - give && heights[1] <= high + give &&
           !has_inverted_cell(*grid_, column, layers);
  });
  if (!is_rock) return;
  for (const int column : hole) {
    layers_[column] = layers;
    is_inside_[column] = 1;
  }
}

int ColumnMap::column_or_none(int i, int j) const {
  const bool is_there = i >= 0 && j >= 0 && i < grid_->size[0] && j < grid_->size[1];
  return is_there ? grid_->column(i, j) : -1;
}

std::array<int, 2> ColumnMap::place_of_pillar(int pillar) const {
  const int n = grid_->size[0] + 1;
  return {pillar % n, pillar / n};
}

std::array<int, 2> ColumnMap::pillars_of(int edge) const {
  const int from = edge / 2;
  return {from, edge % 2 == 0 ? from + 1 : from + grid_->size[0] + 1};
}

int ColumnMap::edge_between(int from, int to) const {
  return 2 * std::min(from, to) + (std::abs(from - to) == 1 ? 0 : 1);
}

int ColumnMap::edge_between_columns(int column, int other) const {
  const std::array<int, 2> a = grid_->place(std::min(column, other)),
                           b = grid_->place(std::max(column, other));
  if (a[1] == b[1] && b[0] == a[0] + 1) return 2 * grid_->pillar(b[0], b[1]) + 1;
  if (a[0] == b[0] && b[1] == a[1] + 1) return 2 * grid_->pillar(b[0], b[1]);
  return -1;
}

std::array<int, 2> ColumnMap::sides(int from, int to) const {
  const std::array<int, 2> a = place_of_pillar(std::min(from, to));
  const bool is_along_i = std::abs(from - to) == 1;
  std::array<int, 2> columns = {column_or_none(a[0], a[1]), column_or_none(a[0], a[1] - 1)};
  if (!is_along_i) columns = {column_or_none(a[0] - 1, a[1]), columns[0]};
  const bool is_backwards = from > to;
  if (is_backwards != is_left_handed_) std::swap(columns[0], columns[1]);
  return columns;
}

std::array<int, 4> ColumnMap::columns_around(int pillar) const {
  const std::array<int, 2> at = place_of_pillar(pillar);
  return {column_or_none(at[0] - 1, at[1] - 1), column_or_none(at[0], at[1] - 1),
          column_or_none(at[0], at[1]), column_or_none(at[0] - 1, at[1])};
}

std::vector<int> ColumnMap::neighbours(int pillar) const {
  const std::array<int, 2> at = place_of_pillar(pillar);
  std::vector<int> all;
  if (at[0] > 0) all.push_back(pillar - 1);
  if (at[0] < grid_->size[0]) all.push_back(pillar + 1);
  if (at[1] > 0) all.push_back(pillar - grid_->size[0] - 1);
  if (at[1] < grid_->size[1]) all.push_back(pillar + grid_->size[0] + 1);
  return all;
}

bool ColumnMap::is_at_edge(int pillar) const {
  return std::ranges::any_of(columns_around(pillar),
                             [&](int column) { return !is_inside(column); });
}

CornerPlace ColumnMap::corner_at(int column, int pillar) const {
  const std::array<int, 2> at = grid_->place(column), on = place_of_pillar(pillar);
  return {on[0] > at[0], on[1] > at[1], false};
}

std::vector<int> ColumnMap::layers_to_compare(int left, int right) const {
  int first = std::max(top_layer(left), top_layer(right)),
      last = std::min(base_layer(left), base_layer(right));
  if (first > last) {
    first = 0;
    last = grid_->size[2] - 1;
  }
  std::vector<int> all, both;
  for (int k = first; k <= last; ++k) {
    all.push_back(k);
    if (grid_->is_active[grid_->cell(left, k)] != 0 && grid_->is_active[grid_->cell(right, k)] != 0)
      both.push_back(k);
  }
  return both.empty() ? all : both;
}

FaultEdge ColumnMap::measured(int from, int to) const {
  const std::array<int, 2> columns = sides(from, to);
  FaultEdge edge{from, to, columns[0], columns[1]};
  const std::vector<int> layers = layers_to_compare(edge.left, edge.right);
  const auto n = static_cast<double>(2 * layers.size());
  bool is_first = true;
  for (const int pillar : {from, to}) {
    CornerPlace left = corner_at(edge.left, pillar), right = corner_at(edge.right, pillar);
    for (const int k : layers) {
      for (const bool bottom : {false, true}) {
        left.bottom = right.bottom = bottom;
        const double offset = grid_->z(edge.left, k, left) - grid_->z(edge.right, k, right);
        (pillar == from ? edge.offset_from : edge.offset_to) += offset / n;
        edge.least = is_first ? offset : std::min(edge.least, offset);
        edge.most = is_first ? offset : std::max(edge.most, offset);
        is_first = false;
      }
    }
  }
  return edge;
}

}  // namespace faultsim::corner_point
