#include "simulator/flow/followed_columns.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "simulator/common/ranges.h"
#include "simulator/flow/flow_cell_search.h"
#include "simulator/flow/nearest_areas.h"

namespace faultsim {
namespace {

constexpr int kNobody = -1;

Eigen::Vector3d place_of(const CellCentre& centre) {
  return {centre.at.x(), centre.at.y(), -centre.depth};
}

/// For each point the nearest one below and above it.
struct NearestOfSides {
  std::vector<int> below, above;  ///< kNobody: none is near.
};

class SideSearch {
 public:
  explicit SideSearch(const std::vector<CellCentre>& centres)
      : centres_(centres), points_(points_of(centres)), search_(points_) {}

  NearestOfSides find() {
    NearestOfSides sides;
    for (const CellCentre& centre : centres_) {
      const std::vector<int> near = around(centre);
      sides.below.push_back(nearest(centre, near, 1));
      sides.above.push_back(nearest(centre, near, -1));
    }
    return sides;
  }

 private:
  static std::vector<FlowCell> points_of(const std::vector<CellCentre>& centres) {
    return mapped(centres, [](const CellCentre& centre) {
      return FlowCell{.low = place_of(centre), .high = place_of(centre)};
    });
  }

  /// At least so many points, if there are, in a cube whose size is that of the cube before.
  std::vector<int> around(const CellCentre& centre) {
    constexpr std::size_t kMany = 16, kTooMany = 4 * kMany;
    const Eigen::Vector3d at = place_of(centre), reach = Eigen::Vector3d::Constant(half_);
    std::vector<int> near = search_.overlapping(at - reach, at + reach);
    const std::size_t most = std::min(kMany, centres_.size());
    if (near.size() > kTooMany) half_ *= 0.8;
    while (near.size() < most) {
      half_ *= 1.3;
      const Eigen::Vector3d more = Eigen::Vector3d::Constant(half_);
      near = search_.overlapping(at - more, at + more);
    }
    return near;
  }

  int nearest(const CellCentre& centre, const std::vector<int>& near, double sense) const {
    int best = kNobody;
    double least = HUGE_VAL;
    for (const int other : near) {
      const CellCentre& theirs = centres_[other];
      if (sense * (theirs.depth - centre.depth) <= 0) continue;
      const double away = (place_of(theirs) - place_of(centre)).squaredNorm();
      if (away >= least) continue;
      least = away;
      best = other;
    }
    return best;
  }

  const std::vector<CellCentre>& centres_;
  std::vector<FlowCell> points_;
  FlowCellSearch search_;
  double half_ = 1;  ///< m
};

/// The points of each column, downwards: those that follow each other in both senses, no more than
/// so far apart on the map.
std::vector<CellColumn> linked(const std::vector<CellCentre>& centres, const NearestOfSides& sides,
                               double most) {
  const auto centre = [&](int number) { return centres[number]; };
  const auto is_link = [&](int above, int below) {
    return above != kNobody && below != kNobody && sides.below[above] == below &&
           sides.above[below] == above && (centre(above).at - centre(below).at).norm() <= most;
  };
  std::vector<CellColumn> columns;
  for (int i = 0; i < static_cast<int>(centres.size()); ++i) {
    if (is_link(sides.above[i], i)) continue;
    std::vector<CellCentre> cells;
    for (int at = i;;) {
      cells.push_back(centre(at));
      cells.back().layer = static_cast<int>(cells.size());
      const int below = sides.below[at];
      if (!is_link(at, below)) break;
      at = below;
    }
    columns.push_back(column_of(std::move(cells)));
  }
  return columns;
}

/// What columns have around a place, smooth over faults.
struct Around {
  double depth;          ///< m
  Eigen::Vector2d lean;  ///< m sideways per m downwards.
};

/// Depths and leans of the planes through the columns around each of them.
std::vector<Around> around_columns(const std::vector<CellColumn>& columns, double reach) {
  const auto on_map = [](const CellColumn& column) -> Eigen::Vector3d {
    return {column.axis.at.x(), column.axis.at.y(), 0};
  };
  const std::vector<FlowCell> points = mapped(columns, [&](const CellColumn& column) {
    return FlowCell{.low = on_map(column), .high = on_map(column)};
  });
  const FlowCellSearch search(points);
  std::vector<Around> all;
  for (const CellColumn& column : columns) {
    const Eigen::Vector3d at = on_map(column), far = Eigen::Vector3d::Constant(reach);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero(), b = Eigen::Matrix3d::Zero();
    for (const int other : search.overlapping(at - far, at + far)) {
      const SlopingLine& axis = columns[other].axis;
      const Eigen::Vector2d off = (axis.at - column.axis.at) / reach;
      const Eigen::Vector3d row(1, off.x(), off.y());
      a += row * row.transpose();
      b += row * Eigen::RowVector3d(axis.depth - column.axis.depth, axis.lean.x(), axis.lean.y());
    }
    constexpr double kTiny = 1e-9;  // those that lie on one line say nothing across it
    a.diagonal().tail<2>().array() += kTiny;
    const Eigen::RowVector3d here = a.ldlt().solve(b).row(0);
    all.push_back({column.axis.depth + here[0], {here[1], here[2]}});
  }
  return all;
}

/// Corners of areas that are one, or nearly: the short edges between them would cross others where
/// pillars lean differently.
class CornerJoiner {
 public:
  explicit CornerJoiner(double near) : near_(near) {}

  int number_of(const Eigen::Vector2d& corner) {
    const std::array<long, 2> bin{std::lround(corner.x() / near_), std::lround(corner.y() / near_)};
    for (const long i : {-1, 0, 1}) {
      for (const long j : {-1, 0, 1}) {
        const auto known = numbers_.find({bin[0] + i, bin[1] + j});
        if (known == numbers_.end() || (joined_[known->second].first - corner).norm() > near_)
          continue;
        Joined& joined = joined_[known->second];
        joined.off += corner - joined.first;
        ++joined.n;
        return known->second;
      }
    }
    const int number = size();
    numbers_[bin] = number;
    joined_.push_back({corner});
    return number;
  }
  int size() const { return static_cast<int>(joined_.size()); }
  Eigen::Vector2d mean(int number) const {
    return joined_[number].first + joined_[number].off / joined_[number].n;
  }

 private:
  struct Joined {
    Eigen::Vector2d first;
    Eigen::Vector2d off = Eigen::Vector2d::Zero();
    double n = 1;
  };
  double near_;
  std::map<std::array<long, 2>, int> numbers_;
  std::vector<Joined> joined_;
};

/// The line through a corner that leans as the columns around it, from their depth:
///   depth = Σ λ_c depth_c, lean = Σ λ_c lean_c,  Σ λ_c = 1, Σ λ_c at_c = corner
/// with the least Σ λ_c² (nearly, where they lie on one line).
SlopingLine pillar_through(const Eigen::Vector2d& corner, const std::vector<int>& columns,
                           const std::vector<Eigen::Vector2d>& places,
                           const std::vector<Around>& around) {
  constexpr double kTiny = 1e-2;
  const double n = static_cast<double>(columns.size());
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const int c : columns) middle += (places[c] - corner) / n;
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (const int c : columns) {
    const Eigen::Vector2d off = places[c] - corner - middle;
    squares += off * off.transpose();
  }
  squares += (kTiny * squares.trace() + 1e-300) * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d slope = squares.ldlt().solve(-middle);
  SlopingLine line{.at = corner};
  for (const int c : columns) {
    const double share = 1 / n + slope.dot(places[c] - corner - middle);
    line.depth += share * around[c].depth;
    line.lean += share * around[c].lean;
  }
  return line;
}

/// Pillars at the corners of the areas of columns. Beside a fault of sloping pillars columns lie
/// over each other on the map, or far apart: so each is taken at the depth of those around it,
/// where they lie beside each other. Pillars that lean as many columns do cross no others.
ColumnGrid with_pillars(std::vector<CellColumn> columns, double spacing) {
  constexpr double kAround = 4;  // spacings
  constexpr double kSame = 0.3;  // of half the spacing
  const std::vector<Around> around = around_columns(columns, kAround * spacing);
  std::vector<Eigen::Vector2d> places;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const SlopingLine& axis = columns[c].axis;
    places.push_back(axis.at + (around[c].depth - axis.depth) * around[c].lean);
  }
  const NearestAreas areas = nearest_areas(places);
  if (areas.area.empty()) return {};
  CornerJoiner joiner(kSame * areas.rim);
  ColumnGrid grid{std::move(columns), {}};
  for (std::size_t c = 0; c < grid.columns.size(); ++c) {
    std::vector<int>& pillars = grid.columns[c].pillars;
    for (const Eigen::Vector2d& corner : areas.area[c]) pillars.push_back(joiner.number_of(corner));
    drop_repeated(pillars);
    while (pillars.size() > 1 && pillars.front() == pillars.back()) pillars.pop_back();
    grid.pillars.resize(static_cast<std::size_t>(joiner.size()));
    for (const int pillar : pillars) grid.pillars[pillar].columns.push_back(static_cast<int>(c));
  }
  for (int p = 0; p < joiner.size(); ++p) {
    CellPillar& pillar = grid.pillars[p];
    pillar.line = pillar_through(joiner.mean(p), pillar.columns, places, around);
  }
  return grid;
}

/// Half the columns are farther from the next one, on the map, m.
double spacing_of(const std::vector<CellColumn>& columns) {
  return 2 * nearest_areas(mapped(columns, [](const CellColumn& column) {
               return column.axis.at;
             })).rim;
}

}  // namespace

ColumnGrid followed_columns(const std::vector<CellCentre>& centres) {
  constexpr double kOfSpacing = 1. / 3;
  const auto are_many = [&](const std::vector<CellColumn>& columns) {
    return 4 * columns.size() > 3 * centres.size();
  };
  const NearestOfSides sides = SideSearch(centres).find();
  std::vector<CellColumn> columns = linked(centres, sides, HUGE_VAL);
  if (are_many(columns)) return {};
  const double spacing = spacing_of(columns);
  columns = linked(centres, sides, kOfSpacing * spacing);
  if (are_many(columns)) return {};
  return with_pillars(std::move(columns), spacing);
}

}  // namespace faultsim
