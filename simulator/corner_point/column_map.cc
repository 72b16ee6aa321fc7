#include "simulator/corner_point/column_map.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace faultsim::corner_point {

ColumnMap::ColumnMap(const CornerPointGrid& grid) : grid_(&grid) {
  double doubled_area = 0;
  for (int column = 0; column < grid.n_columns(); ++column) {
    is_active_.push_back(grid.has_active_cell(column) ? 1 : 0);
    if (is_active_.back() == 0) continue;
    const auto top = [&](bool right, bool back) {
      return Eigen::Vector2d(grid.pillars[grid.pillar_of(column, {right, back})].top.head<2>());
    };
    const Eigen::Vector2d across = top(true, true) - top(false, false),
                          other = top(false, true) - top(true, false);
    doubled_area += across.x() * other.y() - across.y() * other.x();
  }
  is_left_handed_ = doubled_area < 0;
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
                             [&](int column) { return !is_active(column); });
}

CornerPlace ColumnMap::corner_at(int column, int pillar) const {
  const std::array<int, 2> at = grid_->place(column), on = place_of_pillar(pillar);
  return {on[0] > at[0], on[1] > at[1], false};
}

int ColumnMap::top_layer(int column) const {
  int k = 0;
  while (grid_->is_active[grid_->cell(column, k)] == 0) ++k;
  return k;
}

int ColumnMap::base_layer(int column) const {
  int k = grid_->size[2] - 1;
  while (grid_->is_active[grid_->cell(column, k)] == 0) --k;
  return k;
}

std::vector<int> ColumnMap::layers_to_compare(int left, int right) const {
  std::vector<int> all, both;
  for (int k = 0; k < grid_->size[2]; ++k) {
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

double FaultEdge::largest() const { return std::max(std::abs(least), std::abs(most)); }

}  // namespace faultsim::corner_point
