#include "simulator/flow/point_cells.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/flow/column_cells.h"
#include "simulator/flow/column_dips.h"
#include "simulator/flow/flow_cell_search.h"
#include "simulator/flow/followed_columns.h"
#include "simulator/flow/indexed_columns.h"
#include "simulator/flow/nearest_areas.h"
#include "simulator/flow/regular_cells.h"

namespace faultsim {
namespace {

using Reaches = std::vector<std::array<double, 2>>;  ///< [low, high] per point, m.

/// The prism over a convex polygon, as hexahedra (the last one pinched) that share their faces.
void add_prisms(const ConvexPolygon& base, double low, double high, std::vector<FlowCell>& cells) {
  for (std::size_t i = 1; i + 1 < base.size(); i += 2) {
    const std::array<std::size_t, 4> of{0, i, i + 1, std::min(i + 2, base.size() - 1)};
    CellCorners corners;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = {base[of[k]].x(), base[of[k]].y(), low};
      corners[k + 4] = {base[of[k]].x(), base[of[k]].y(), high};
    }
    cells.push_back(flow_cell_around(corners));
  }
}

/// Whether boxes lie over each other, by more than half a percent of their volume.
bool are_over_each_other(const std::vector<FlowCell>& boxes) {
  constexpr double kMost = 0.005;
  const FlowCellSearch search(boxes);
  double volume = 0, shared = 0;
  for (std::size_t c = 0; c < boxes.size(); ++c) {
    const FlowCell& box = boxes[c];
    volume += (box.high - box.low).prod();
    for (const int other : search.overlapping(box.low, box.high)) {
      if (other <= static_cast<int>(c)) continue;
      const FlowCell& theirs = boxes[static_cast<std::size_t>(other)];
      shared += (box.high.cwiseMin(theirs.high) - box.low.cwiseMax(theirs.low)).prod();
    }
  }
  return shared > kMost * volume;
}

class PointCellMaker {
 public:
  PointCellMaker(const TablePoints& points, TableReader& reader)
      : points_(points), reader_(reader) {
    for (const auto& place : points.places) {
      const std::array<double, 2> at{place[0], place[1]};
      column_.push_back(columns_.try_emplace(at, static_cast<int>(columns_.size())).first->second);
    }
  }

  PointCells make() {
    if (may_have_columns()) {
      if (!points_.indices.empty())
        add_indexed();
      else if (is_sloping())
        add_followed();
      if (!result_.cells.empty() || !reader_.is_sound()) return std::move(result_);
    }
    const Reaches depth = depths();
    if (is_cloud()) {
      add_areas(depth);
    } else {
      const Reaches x = reach(0), y = reach(1);
      for (std::size_t i = 0; reader_.is_sound() && i < points_.places.size(); ++i)
        add({{x[i][0], y[i][0], -depth[i][1]}, {x[i][1], y[i][1], -depth[i][0]}}, i);
    }
    if (!uneven_.empty()) {
      result_.notes.insert(
          result_.notes.begin(),
          "has points that are not equally spaced along " + joined(uneven_, ", ") +
              ": its cells are those that lie side by side with a point in the middle of each, or "
              "reach halfway to the next point");
    }
    return std::move(result_);
  }

 private:
  void add(FlowCell cell, std::size_t point) {
    result_.cells.push_back(std::move(cell));
    result_.point.push_back(point);
  }

  std::vector<double> along(std::size_t axis) const {
    std::vector<double> at;
    for (const auto& place : points_.places) at.push_back(place[axis]);
    return at;
  }
  std::size_t n_values(std::size_t axis) const {
    const std::vector<double> at = along(axis);
    return std::set<double>(at.begin(), at.end()).size();
  }

  bool has(std::size_t column) const { return points_.has_column[column]; }
  static constexpr std::size_t kDx = kFirstSizeColumn, kDy = kDx + 1, kDz = kDx + 2;

  /// Not where all is said, and fits.
  bool may_have_columns() const {
    if (!has(kDepthColumn)) return false;
    if (!has(kDx) || !has(kDy) || !has(kDz)) return true;
    return are_over_each_other(mapped(points_.places, [](const TablePoints::Place& p) {
      const Eigen::Vector3d at(p[0], p[1], -p[2]), half(0.5 * p[3], 0.5 * p[4], 0.5 * p[5]);
      return FlowCell{.low = at - half, .high = at + half};
    }));
  }

  CellCentre centre(std::size_t point) const {
    const TablePoints::Place& p = points_.places[point];
    return {.at = {p[0], p[1]}, .depth = p[2], .layer = 0, .thickness = p[kDz], .point = point};
  }

  /// Whether many points have an x and y that no other one has.
  bool is_sloping() const {
    constexpr std::size_t kMany = 10;
    std::vector<std::size_t> n(columns_.size());
    for (const int column : column_) ++n[static_cast<std::size_t>(column)];
    const auto n_alone = static_cast<std::size_t>(std::ranges::count(n, std::size_t{1}));
    return kMany * n_alone > points_.places.size();
  }

  /// Columns of cells, unless few points follow each other.
  void add_followed() {
    constexpr double kFewer = 0.75;  // than there are places on the map
    std::vector<CellCentre> centres;
    for (std::size_t i = 0; i < points_.places.size(); ++i) centres.push_back(centre(i));
    ColumnGrid grid = followed_columns(centres);
    const auto n = static_cast<double>(grid.columns.size());
    if (grid.columns.empty() || n > kFewer * static_cast<double>(columns_.size())) return;
    add_columns(grid);
    result_.notes.push_back(concat(
        "has points on sloping lines: they were taken as ", grid.columns.size(),
        " columns of cells, each where it is the nearest one; columns i, j, k would say more"));
  }

  void add_columns(ColumnGrid& grid, bool uses_neighbours = true) {
    set_borders(grid.columns);
    find_dips(grid.columns, grid.pillars);
    ColumnCells cells = cells_of_columns(grid);
    result_.cells = std::move(cells.cells);
    result_.point = std::move(cells.point);
    if (uses_neighbours && (has(kDx) || has(kDy))) {
      result_.notes.emplace_back(
          "has sizes dx and dy that are not used: cells reach halfway to those beside them");
    }
  }

  void add_indexed() {
    std::vector<IndexedCell> cells;
    for (std::size_t i = 0; i < points_.places.size(); ++i) {
      const auto& [ci, cj, ck] = points_.indices[i];
      cells.push_back({.centre = centre(i), .i = ci, .j = cj});
      cells.back().centre.layer = ck;
    }
    const bool is_plain = stands_upright() && !is_no_grid();
    const Reaches x = is_plain ? reach(0) : Reaches{}, y = is_plain ? reach(1) : Reaches{};
    if (!reader_.is_sound()) return;
    PlanCorner corner;
    if (is_plain) {
      corner = [&](std::size_t point, const Eigen::Vector2d& towards) {
        return Eigen::Vector2d(x[point][towards.x() > 0 ? 1 : 0],
                               y[point][towards.y() > 0 ? 1 : 0]);
      };
    }
    const TablePoints::Place& first = points_.places[0];
    ColumnGrid grid = indexed_columns(cells, {first[kDx], first[kDy]}, corner);
    if (grid.columns.empty()) {
      return reader_.refuse_at(
          points_.lines[0],
          "no two cells follow each other along i, or none along j: their width "
          "is not known",
          "add columns dx [m] and dy [m], or leave i, j, k out");
    }
    if (!has(kDz) && !has_layers(grid)) {
      return reader_.refuse_at(
          points_.lines[0], "no two cells follow each other along k: their thickness is not known",
          "add a column dz [m]");
    }
    add_columns(grid, !is_plain);
    result_.notes.push_back(
        concat("has i, j, k: ", grid.columns.size(),
               " columns of cells, whose corners lie halfway between neighbouring centres"));
  }

  static bool has_layers(const ColumnGrid& grid) {
    return std::ranges::any_of(grid.columns, [](const CellColumn& column) {
      for (std::size_t i = 1; i < column.cells.size(); ++i) {
        if (column.cells[i].touches(column.cells[i - 1])) return true;
      }
      return false;
    });
  }

  /// Whether cells of the same i and j have the same x and y.
  bool stands_upright() const {
    std::map<std::array<int, 2>, int> column_at;
    for (std::size_t i = 0; i < column_.size(); ++i) {
      const auto& index = points_.indices[i];
      const int known = column_at.try_emplace({index[0], index[1]}, column_[i]).first->second;
      if (known != column_[i]) return false;
    }
    return true;
  }

  bool is_cloud() const { return !has(kDx) && !has(kDy) && is_no_grid(); }

  /// Whether points are no grid along x and y: neither spacing is regular, and few of the places
  /// where their x and y cross have points.
  bool is_no_grid() const {
    constexpr std::size_t kSparse = 4;
    if (kSparse * columns_.size() >= n_values(0) * n_values(1)) return false;
    const std::vector<int> one_line(points_.places.size(), 0);
    const auto is_odd = [&](std::size_t axis) {
      return !regular_cells(one_line, along(axis)).what.empty();
    };
    return is_odd(0) || is_odd(1);
  }

  /// Downwards; empty after a refusal.
  Reaches depths() {
    if (points_.has_column[kDepthColumn]) return reach(kDepthColumn);
    constexpr double kFar = 1e5;  // m
    result_.notes.emplace_back("has no depth: its values hold at all depths");
    Reaches all(points_.places.size());
    all.assign(points_.places.size(), {-kFar, kFar});
    return all;
  }

  Reaches reach(std::size_t axis) {
    const std::size_t size = kFirstSizeColumn + axis;
    if (!points_.has_column[size]) return inferred_reach(axis);
    Reaches given;
    for (const auto& p : points_.places)
      given.push_back({p[axis] - 0.5 * p[size], p[axis] + 0.5 * p[size]});
    return given;
  }

  Reaches inferred_reach(std::size_t axis) {
    const bool is_depth = axis == kDepthColumn;
    const std::vector<int> line = is_depth ? column_ : std::vector<int>(points_.places.size(), 0);
    const std::vector<double> at = along(axis);
    CellReach cells = regular_cells(line, at);
    if (cells.what.empty()) return std::move(cells.reach);
    const bool has_gap = is_depth ? columns_.size() < points_.places.size() : n_values(axis) > 1;
    if (has_gap) {
      uneven_.emplace_back(kPlaceColumns[axis]);
      return uneven_cells(line, at);
    }
    refuse_single(axis, cells);
    return Reaches(points_.places.size());
  }

  void refuse_single(std::size_t axis, const CellReach& cells) {
    const std::string name = kPlaceColumns[axis], size = kPlaceColumns[kFirstSizeColumn + axis];
    const bool is_depth = axis == kDepthColumn;
    const bool is_single = n_values(axis) == 1;
    reader_.refuse_at(points_.lines[cells.cell],
                      name + " " +
                          (is_single ? cells.what
                                     : "has one value at each place, as no two points have the "
                                       "same x and y") +
                          ": the size of the cells is not known",
                      "add a column " + size + " [m]" +
                          (is_depth ? std::string(", or leave depth out: the values then hold at "
                                                  "all depths") +
                                          (is_single ? ""
                                                     : "; points of one column of cells need the "
                                                       "same x and y, or the EGRID in place of a "
                                                       "table")
                                    : ""));
  }

  void add_areas(const Reaches& depth) {
    std::vector<Eigen::Vector2d> places(columns_.size());
    for (const auto& [at, number] : columns_)
      places[static_cast<std::size_t>(number)] = {at[0], at[1]};
    const NearestAreas areas = nearest_areas(places);
    if (areas.area.empty()) {
      return reader_.refuse_at(
          points_.lines[0],
          "all points lie on one line in plan: the width of their cells is not known",
          "add columns dx [m] and dy [m]");
    }
    for (std::size_t i = 0; reader_.is_sound() && i < points_.places.size(); ++i) {
      const auto& base = areas.area[static_cast<std::size_t>(column_[i])];
      add_prisms(base, -depth[i][1], -depth[i][0], result_.cells);
      result_.point.resize(result_.cells.size(), i);
    }
    result_.notes.insert(result_.notes.begin(),
                         concat("has points at ", places.size(),
                                " places that are not a grid along x and y: each holds where it is "
                                "the nearest one, to ",
                                formatted("%.3g", areas.rim), " m beyond their outline"));
  }

  const TablePoints& points_;
  TableReader& reader_;
  std::map<std::array<double, 2>, int> columns_;  ///< of points above each other.
  std::vector<int> column_;                       ///< of each point.
  std::vector<std::string> uneven_;               ///< axes.
  PointCells result_;
};

}  // namespace

PointCells point_cells(const TablePoints& points, TableReader& reader) {
  PointCells cells = PointCellMaker(points, reader).make();
  return reader.is_sound() ? cells : PointCells{};
}

}  // namespace faultsim
