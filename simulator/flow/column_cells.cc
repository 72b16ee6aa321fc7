#include "simulator/flow/column_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "simulator/flow/column_dips.h"

namespace faultsim {
namespace {

/// What lies on one pillar, per border of a column: depths, m.
using EdgeDepths = std::vector<double>;

/// How deep a column's plane that is `depth` deep on its axis lies on a pillar.
double depth_on(const SlopingLine& pillar, const CellColumn& column, double depth) {
  constexpr double kSteep = 0.2;  // the pillar lies in the plane, nearly
  const double rise = 1 - column.dip.dot(pillar.lean);
  return depth + column.dip.dot(pillar(depth) - column.axis(depth)) / (rise > kSteep ? rise : 1);
}

bool is_one_surface(const SlopingLine& pillar, const CellColumn& a, const CellColumn& b) {
  const CommonDepth depth = common_depth(a, b);
  return depth.is_any &&
         std::abs(depth_on(pillar, a, depth.own) - depth_on(pillar, b, depth.other)) <=
             kMeets * std::min(a.height(), b.height());
}

class ColumnRebuilder {
 public:
  explicit ColumnRebuilder(const ColumnGrid& grid)
      : columns_(grid.columns), pillars_(grid.pillars), is_indexed_(grid.is_indexed) {
    for (const CellColumn& column : columns_)
      edges_.emplace_back(column.pillars.size(), EdgeDepths(column.borders.size()));
  }

  ColumnCells make() {
    for (std::size_t p = 0; p < pillars_.size(); ++p) join_at(static_cast<int>(p));
    for (std::size_t c = 0; c < columns_.size(); ++c) add_column(c);
    return std::move(result_);
  }

 private:
  /// Numbers of the surfaces that meet at a pillar, per column around it.
  std::vector<std::size_t> surfaces_at(const CellPillar& pillar) const {
    std::vector<std::size_t> surface(pillar.columns.size());
    std::iota(surface.begin(), surface.end(), 0);
    for (std::size_t i = 0; i < surface.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const std::size_t own = surface[i], other = surface[k];
        if (own != other &&
            is_one_surface(pillar.line, columns_[pillar.columns[i]], columns_[pillar.columns[k]]))
          std::ranges::replace(surface, own, other);
      }
    }
    return surface;
  }

  /// Gives the columns around a pillar their depths on it.
  void join_at(int number) {
    const CellPillar& pillar = pillars_[number];
    const std::vector<std::size_t> surface = surfaces_at(pillar);
    struct Sum {
      double depth = 0, n = 0;
    };
    std::map<std::pair<std::size_t, int>, Sum> sums;  // by surface and border
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const CellColumn& column = columns_[pillar.columns[i]];
      for (const CellBorder& border : column.borders) {
        Sum& sum = sums[{surface[i], border.layer}];
        sum.depth += depth_on(pillar.line, column, border.depth);
        ++sum.n;
      }
    }
    for (std::size_t i = 0; i < surface.size(); ++i) {
      const CellColumn& column = columns_[pillar.columns[i]];
      const auto edge = std::ranges::find(column.pillars, number) - column.pillars.begin();
      EdgeDepths& depths = edges_[pillar.columns[i]][edge];
      for (std::size_t b = 0; b < depths.size(); ++b) {
        const Sum& sum = sums[{surface[i], column.borders[b].layer}];
        depths[b] = sum.depth / sum.n;
        if (b > 0) depths[b] = std::max(depths[b], depths[b - 1]);
      }
    }
  }

  Eigen::Vector3d corner(std::size_t c, std::size_t edge, std::size_t border) const {
    const double depth = edges_[c][edge][border];
    const Eigen::Vector2d at = pillars_[columns_[c].pillars[edge]].line(depth);
    return {at.x(), at.y(), -depth};
  }

  /// Cells of an indexed grid are hexahedra. Between other pillars cells are prisms of three: with
  /// pillars by number each face is cut from the bottom of the one to the top of the next in the
  /// cells on both of its sides. Those that pillars of different leans turn inside out are left
  /// out.
  void add_column(std::size_t c) {
    const std::size_t n = columns_[c].pillars.size();
    if (is_indexed_) return add_cells(c, {0, 1, 2, 3});
    for (std::size_t i = 1; i + 1 < n; ++i) {
      std::array<std::size_t, 3> of{0, i, i + 1};
      if (is_inside_out(c, of)) continue;
      std::ranges::sort(of, {}, [&](std::size_t edge) { return columns_[c].pillars[edge]; });
      add_cells(c, {of[0], of[1], of[2], of[2]});
    }
  }

  /// Whether three pillars, counter-clockwise where they are drawn, are not so at the column.
  bool is_inside_out(std::size_t c, const std::array<std::size_t, 3>& edges) const {
    std::array<Eigen::Vector2d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      const SlopingLine& pillar = pillars_[columns_[c].pillars[edges[k]]].line;
      at[k] = pillar(depth_on(pillar, columns_[c], columns_[c].axis.depth));
    }
    const Eigen::Vector2d a = at[1] - at[0], b = at[2] - at[0];
    return a.x() * b.y() - a.y() * b.x() <= 0;
  }

  /// @param edges  pillars around the column.
  void add_cells(std::size_t c, const std::array<std::size_t, 4>& edges) {
    for (std::size_t l = 0; l < columns_[c].cells.size(); ++l) {
      const std::size_t top = columns_[c].tops[l], bottom = top + 1;
      CellCorners corners;
      for (std::size_t k = 0; k < 4; ++k) {
        corners[k] = corner(c, edges[k], bottom);
        corners[k + 4] = corner(c, edges[k], top);
      }
      add(flow_cell_around(corners), columns_[c].cells[l].point);
    }
  }

  /// What has no thickness holds nothing.
  void add(FlowCell cell, std::size_t point) {
    if ((cell.high.array() <= cell.low.array()).any()) return;
    result_.cells.push_back(std::move(cell));
    result_.point.push_back(point);
  }

  const std::vector<CellColumn>& columns_;
  const std::vector<CellPillar>& pillars_;
  bool is_indexed_;
  std::vector<std::vector<EdgeDepths>> edges_;  ///< per column and pillar around it
  ColumnCells result_;
};

}  // namespace

ColumnCells cells_of_columns(const ColumnGrid& grid) { return ColumnRebuilder(grid).make(); }

}  // namespace faultsim
