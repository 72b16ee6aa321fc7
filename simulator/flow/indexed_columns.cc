#include "simulator/flow/indexed_columns.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace faultsim {
namespace {

using ColumnIndex = std::array<int, 2>;  ///< i, j

/// Makes k grow downwards.
void turn_downwards(std::vector<std::vector<CellCentre>>& columns) {
  double sense = 0;
  for (auto& cells : columns) {
    std::ranges::sort(cells, {}, &CellCentre::layer);
    sense += cells.back().depth - cells.front().depth;
  }
  if (sense >= 0) return;
  for (auto& cells : columns) {
    std::ranges::reverse(cells);
    for (CellCentre& cell : cells) cell.layer = -cell.layer;
  }
}

class IndexedGridMaker {
 public:
  IndexedGridMaker(const std::vector<IndexedCell>& cells, const std::array<double, 2>& width,
                   const PlanCorner& corner)
      : width_(width), corner_(corner) {
    std::vector<std::vector<CellCentre>> columns;
    for (const IndexedCell& cell : cells) {
      const auto [known, is_new] =
          numbers_.try_emplace({cell.i, cell.j}, static_cast<int>(columns.size()));
      if (is_new) {
        columns.emplace_back();
        indices_.push_back({cell.i, cell.j});
      }
      columns[known->second].push_back(cell.centre);
    }
    turn_downwards(columns);
    for (auto& column : columns) grid_.columns.push_back(column_of(std::move(column)));
  }

  ColumnGrid make() {
    if (!find_mean_steps()) return {};
    for (int c = 0; c < static_cast<int>(indices_.size()); ++c) {
      const auto [i, j] = index(c);
      grid_.columns[c].pillars = {pillar(i, j), pillar(i + 1, j), pillar(i + 1, j + 1),
                                  pillar(i, j + 1)};
    }
    grid_.is_indexed = true;
    return std::move(grid_);
  }

 private:
  const ColumnIndex& index(int column) const { return indices_[column]; }
  const CellColumn& column(int number) const { return grid_.columns[number]; }
  std::optional<int> number_of(const ColumnIndex& at) const {
    const auto known = numbers_.find(at);
    if (known == numbers_.end()) return std::nullopt;
    return known->second;
  }
  std::optional<int> neighbour(int column, std::size_t axis, int by) const {
    ColumnIndex at = index(column);
    at[axis] += by;
    return number_of(at);
  }

  /// To the next column along i or j, at a depth; none: neither neighbour is there.
  std::optional<Eigen::Vector2d> own_step(int c, std::size_t axis, double depth) const {
    const std::optional<int> next = neighbour(c, axis, 1), last = neighbour(c, axis, -1);
    const Eigen::Vector2d own = column(c).axis(depth);
    if (next && last) return 0.5 * (column(*next).axis(depth) - column(*last).axis(depth));
    if (next) return column(*next).axis(depth) - own;
    if (last) return own - column(*last).axis(depth);
    return std::nullopt;
  }

  /// The same, else what the columns beside it have, else all.
  Eigen::Vector2d step(int c, std::size_t axis, double depth) const {
    if (const auto own = own_step(c, axis, depth)) return *own;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int n = 0;
    for (const int by : {-1, 1}) {
      const std::optional<int> beside = neighbour(c, 1 - axis, by);
      const std::optional<Eigen::Vector2d> theirs =
          beside ? own_step(*beside, axis, depth) : std::nullopt;
      if (!theirs) continue;
      sum += *theirs;
      ++n;
    }
    return n > 0 ? Eigen::Vector2d(sum / n) : mean_step_[axis];
  }

  /// False where they are known neither along i nor along j, or cannot be told.
  bool find_mean_steps() {
    std::array<int, 2> n{};
    for (int c = 0; c < static_cast<int>(indices_.size()); ++c) {
      for (const std::size_t axis : {0U, 1U}) {
        if (const auto own = own_step(c, axis, column(c).axis.depth)) {
          mean_step_[axis] += *own;
          ++n[axis];
        }
      }
    }
    for (const std::size_t axis : {0U, 1U}) {
      if (n[axis] > 0) mean_step_[axis] /= n[axis];
    }
    for (const std::size_t axis : {0U, 1U}) {
      if (n[axis] > 0) continue;
      if (width_[axis] <= 0) return false;
      // Across the row; a single column lies along x and y.
      const Eigen::Vector2d along = n[1 - axis] > 0
                                        ? mean_step_[1 - axis].normalized()
                                        : Eigen::Vector2d(axis == 0 ? 0 : 1, axis == 0 ? 1 : 0);
      mean_step_[axis] = width_[axis] * Eigen::Vector2d(along.y(), -along.x());
    }
    return true;
  }

  /// Where a column sees the corner that is ±½ along i and j from it.
  Eigen::Vector2d seen_from(int c, double by_i, double by_j, double depth) const {
    const Eigen::Vector2d towards = by_i * step(c, 0, depth) + by_j * step(c, 1, depth);
    return corner_ ? corner_(column(c).cells.front().point, towards)
                   : Eigen::Vector2d(column(c).axis(depth) + towards);
  }

  /// The number of the pillar between the columns (i - 1, j - 1) and (i, j).
  int pillar(int i, int j) {
    const auto [known, is_new] =
        pillars_.try_emplace({i, j}, static_cast<int>(grid_.pillars.size()));
    if (!is_new) return known->second;
    CellPillar pillar;
    std::vector<std::array<double, 2>> towards;
    for (const int by_j : {-1, 0}) {
      for (const int by_i : {-1, 0}) {
        const std::optional<int> number = number_of({i + by_i, j + by_j});
        if (!number) continue;
        pillar.columns.push_back(*number);
        towards.push_back({-0.5 - by_i, -0.5 - by_j});
      }
    }
    const double n = static_cast<double>(pillar.columns.size());
    for (const int c : pillar.columns) {
      pillar.line.depth += column(c).axis.depth / n;
      pillar.line.lean += column(c).axis.lean / n;
    }
    // From the first one, so that equal ones give the same.
    const auto seen = [&](std::size_t k) {
      return seen_from(pillar.columns[k], towards[k][0], towards[k][1], pillar.line.depth);
    };
    pillar.line.at = seen(0);
    Eigen::Vector2d off = Eigen::Vector2d::Zero();
    for (std::size_t k = 1; k < towards.size(); ++k) off += (seen(k) - pillar.line.at) / n;
    pillar.line.at += off;
    grid_.pillars.push_back(std::move(pillar));
    return known->second;
  }

  const std::array<double, 2>& width_;
  const PlanCorner& corner_;
  ColumnGrid grid_;
  std::vector<ColumnIndex> indices_;  ///< of the columns.
  std::map<ColumnIndex, int> numbers_, pillars_;
  std::array<Eigen::Vector2d, 2> mean_step_{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

}  // namespace

ColumnGrid indexed_columns(const std::vector<IndexedCell>& cells,
                           const std::array<double, 2>& width, const PlanCorner& corner) {
  return IndexedGridMaker(cells, width, corner).make();
}

}  // namespace faultsim
