#include "simulator/flow/point_cells.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
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
          "has points that are not equally far from each other along " + joined(uneven_, ", ") +
              ": its cells are those that lie side by side with a point in the middle of each, or "
              "reach half way to the next point");
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

  /// Whether points are no grid along x and y: neither spacing is regular, and few of the places
  /// where their x and y cross have points.
  bool is_cloud() const {
    if (points_.has_column[kFirstSizeColumn] || points_.has_column[kFirstSizeColumn + 1])
      return false;
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
      return reader_.refuse_at(points_.lines[0],
                               "all points lie on one line in the plan: how wide their cells are "
                               "is not known",
                               "add columns dx [m] and dy [m]");
    }
    for (std::size_t i = 0; reader_.is_sound() && i < points_.places.size(); ++i) {
      const auto& base = areas.area[static_cast<std::size_t>(column_[i])];
      add_prisms(base, -depth[i][1], -depth[i][0], result_.cells);
      result_.point.resize(result_.cells.size(), i);
    }
    result_.notes.insert(
        result_.notes.begin(),
        concat(
            "has points at ", places.size(),
            " places that are no grid along x and y: each holds where it is the nearest one, to ",
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
