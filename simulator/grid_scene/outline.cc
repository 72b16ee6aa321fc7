#include "simulator/grid_scene/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "simulator/common/errors.h"
#include "simulator/corner_point/straight_trace.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::ColumnMap;
using corner_point::CornerPointGrid;
using corner_point::cross_product;
using corner_point::RemarkKind;
using Eigen::Vector2d;

/// Columns that count as active once what sticks out and small holes are smoothed away.
class SmoothMask {
 public:
  explicit SmoothMask(const ColumnMap& map) : size_(map.grid().size) {
    std::vector<char> before;
    for (int column = 0; column < map.grid().n_columns(); ++column) {
      is_in_.push_back(map.is_inside(column) ? 1 : 0);
      before.push_back(map.grid().has_active_cell(column) ? 1 : 0);
    }
    constexpr int kRounds = 20;
    bool has_changed = true;
    for (int round = 0; round < kRounds && has_changed; ++round) has_changed = smooth();
    drop_small_parts(false);
    drop_small_parts(true);
    fill_pinches();
    for (std::size_t c = 0; c < before.size(); ++c) {
      n_dropped += before[c] > is_in_[c] ? 1 : 0;
      n_filled += before[c] < is_in_[c] ? 1 : 0;
    }
  }

  bool is_in(int i, int j) const {
    return i >= 0 && j >= 0 && i < size_[0] && j < size_[1] && is_in_[i + size_[0] * j] != 0;
  }
  int n_dropped = 0, n_filled = 0;

 private:
  int n_neighbours(int i, int j) const {
    return is_in(i - 1, j) + is_in(i + 1, j) + is_in(i, j - 1) + is_in(i, j + 1);
  }

  bool smooth() {
    bool has_changed = false;
    for (int j = 0; j < size_[1]; ++j) {
      for (int i = 0; i < size_[0]; ++i) {
        char& here = is_in_[i + size_[0] * j];
        const int n = n_neighbours(i, j);
        const bool wants = here != 0 ? n >= 2 : n >= 3;
        if (wants == (here != 0)) continue;
        here = wants ? 1 : 0;
        has_changed = true;
      }
    }
    return has_changed;
  }

  /// Parts of columns that are in (or out, without touching the grid's edge) of a few columns.
  void drop_small_parts(bool out) {
    constexpr std::size_t kFewest = 9;
    std::vector<char> is_seen(is_in_.size(), 0);
    std::size_t largest = 0;
    std::vector<std::vector<int>> parts;
    for (int begin = 0; begin < static_cast<int>(is_in_.size()); ++begin) {
      if (is_seen[begin] != 0 || (is_in_[begin] == 0) != out) continue;
      std::vector<int> part = {begin};
      is_seen[begin] = 1;
      bool is_at_edge = false;
      for (std::size_t next = 0; next < part.size(); ++next) {
        const int i = part[next] % size_[0], j = part[next] / size_[0];
        for (const auto& [x, y] : {std::array{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
          if (x < 0 || y < 0 || x >= size_[0] || y >= size_[1]) {
            is_at_edge = true;
            continue;
          }
          const int other = x + size_[0] * y;
          if (is_seen[other] != 0 || (is_in_[other] == 0) != out) continue;
          is_seen[other] = 1;
          part.push_back(other);
        }
      }
      largest = std::max(largest, part.size());
      if (!out || !is_at_edge) parts.push_back(std::move(part));
    }
    for (const std::vector<int>& part : parts) {
      if (part.size() >= kFewest || (!out && part.size() == largest)) continue;
      for (const int column : part) is_in_[column] = out ? 1 : 0;
    }
  }

  /// Where columns meet at a corner only, one of those between is filled.
  void fill_pinches() {
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      for (int j = 0; j + 1 < size_[1]; ++j) {
        for (int i = 0; i + 1 < size_[0]; ++i) {
          const bool rising = is_in(i, j) && is_in(i + 1, j + 1),
                     falling = is_in(i + 1, j) && is_in(i, j + 1);
          const int n = is_in(i, j) + is_in(i + 1, j) + is_in(i, j + 1) + is_in(i + 1, j + 1);
          if (n != 2 || !(rising || falling)) continue;
          is_in_[(rising ? i + 1 : i) + size_[0] * j] = 1;
          has_changed = true;
        }
      }
    }
  }

  std::array<int, 3> size_;
  std::vector<char> is_in_;
};

/// Closed lines of pillars around the mask, the columns in it to the left of those who go on with i
/// and j to the right and up.
std::vector<std::vector<int>> loops_around(const CornerPointGrid& grid, const SmoothMask& mask) {
  std::map<int, int> next;
  for (int j = 0; j < grid.size[1]; ++j) {
    for (int i = 0; i < grid.size[0]; ++i) {
      if (!mask.is_in(i, j)) continue;
      if (!mask.is_in(i, j - 1)) next[grid.pillar(i, j)] = grid.pillar(i + 1, j);
      if (!mask.is_in(i + 1, j)) next[grid.pillar(i + 1, j)] = grid.pillar(i + 1, j + 1);
      if (!mask.is_in(i, j + 1)) next[grid.pillar(i + 1, j + 1)] = grid.pillar(i, j + 1);
      if (!mask.is_in(i - 1, j)) next[grid.pillar(i, j + 1)] = grid.pillar(i, j);
    }
  }
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      loop.push_back(at->second);
      next.erase(at);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// Where a pillar is at the middle of what is active around it.
Vector2d place_of(const ColumnMap& map, int pillar, double reference_z) {
  double sum = 0;
  int n = 0;
  for (const int column : map.columns_around(pillar)) {
    if (!map.is_inside(column)) continue;
    corner_point::CornerPlace corner = map.corner_at(column, pillar);
    sum += map.grid().z(column, map.top_layer(column), corner);
    corner.bottom = true;
    sum += map.grid().z(column, map.base_layer(column), corner);
    n += 2;
  }
  return map.grid().pillars[pillar].at(n > 0 ? sum / n : reference_z);
}

/// A closed line of fewest pieces, near to fewest, from which no point is farther than a
/// tolerance: two halves between points that are far apart, each fitted by itself.
/// @param corners  of pillars, in turn.
Polyline simplified(const Polyline& corners, double tolerance) {
  const std::size_t n = corners.size();
  const auto farthest = [&](const Vector2d& from) {
    std::size_t far = 0;
    for (std::size_t k = 1; k < n; ++k) {
      if ((corners[k] - from).norm() > (corners[far] - from).norm()) far = k;
    }
    return far;
  };
  const std::size_t first = farthest(corners[0]), second = farthest(corners[first]);
  const auto fitted = [&](std::size_t from, std::size_t to) {
    Polyline part = {corners[from]};
    for (std::size_t k = from; k != to; k = (k + 1) % n) part.push_back(corners[(k + 1) % n]);
    return corner_point::straight_trace(part, tolerance);
  };
  Polyline there = fitted(first, second), back = fitted(second, first);
  there.front() = (there.front() + back.back()) / 2;
  there.back() = (there.back() + back.front()) / 2;
  there.insert(there.end(), back.begin() + 1, back.end() - 1);
  return there;
}

/// The corner to take out next: a sharp one, or one of a short piece; none where all may stay.
std::optional<std::size_t> corner_to_drop(const Polyline& line, double shortest) {
  constexpr double kSharpest = 50 * std::numbers::pi / 180;
  const std::size_t n = line.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vector2d before = line[(k + n - 1) % n] - line[k], after = line[(k + 1) % n] - line[k];
    const double angle =
        std::acos(std::clamp(before.dot(after) / (before.norm() * after.norm()), -1.0, 1.0));
    if (angle < kSharpest) return k;
    if (after.norm() >= shortest) continue;
    // Of the two ends of a short piece the one at which the line turns less.
    const Vector2d further = line[(k + 2) % n] - line[(k + 1) % n];
    const double turn = std::abs(cross_product(before.normalized(), after.normalized()));
    const double next_turn = std::abs(cross_product(after.normalized(), further.normalized()));
    return turn < next_turn ? k : (k + 1) % n;
  }
  return std::nullopt;
}

/// Warns where more than a few active columns lie outside the outlines.
void say_outside(const ColumnMap& map, const std::vector<Polyline>& outlines, double reference_z,
                 Remarks& remarks) {
  constexpr double kFew = 0.03;
  const CornerPointGrid& grid = map.grid();
  int n_active = 0, n_outside = 0;
  for (int column = 0; column < grid.n_columns(); ++column) {
    if (!grid.has_active_cell(column)) continue;
    Vector2d middle(0, 0);
    for (const bool right : {false, true}) {
      for (const bool back : {false, true})
        middle += place_of(map, grid.pillar_of(column, {right, back}), reference_z) / 4;
    }
    n_active += 1;
    n_outside += is_within(outlines, middle) ? 0 : 1;
  }
  if (n_outside <= kFew * n_active) return;
  remarks.push_back({RemarkKind::warning,
                     concat("the outline leaves out ", n_outside, " of ",
                            counted(n_active, "active column", "active columns"),
                            ": their pressures count with the compartment that is nearest"),
                     "/geometry/dividers"});
}

}  // namespace

std::vector<Polyline> active_outlines(const ColumnMap& map, double cell, double reference_z,
                                      Remarks& remarks) {
  const SmoothMask mask(map);
  std::vector<Polyline> outlines;
  double doubled_area = 0;
  for (const std::vector<int>& loop : loops_around(map.grid(), mask)) {
    Polyline corners;
    for (const int pillar : loop) corners.push_back(place_of(map, pillar, reference_z));
    Polyline line = simplified(corners, 0.5 * cell);
    while (line.size() > 3) {
      const std::optional<std::size_t> corner = corner_to_drop(line, cell);
      if (!corner) break;
      line.erase(line.begin() + static_cast<std::ptrdiff_t>(*corner));
    }
    if (line.size() < 3) continue;
    for (std::size_t k = 0; k < line.size(); ++k)
      doubled_area += cross_product(line[k], line[(k + 1) % line.size()]);
    outlines.push_back(std::move(line));
  }
  // A grid whose j runs against y has its columns to the right.
  if (doubled_area < 0) {
    for (Polyline& line : outlines) std::ranges::reverse(line);
  }
  if (mask.n_dropped + mask.n_filled > 0)
    remarks.push_back(
        {RemarkKind::choice,
         concat("the outline of the active map leaves out ",
                counted(mask.n_dropped, "column that sticks out", "columns that stick out"),
                ", and takes in ", counted(mask.n_filled, "inactive one", "inactive ones")),
         ""});
  say_outside(map, outlines, reference_z, remarks);
  return outlines;
}

Polyline hull_of(Polyline points) {
  const auto before = [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::ranges::sort(points, before);
  Polyline hull;
  for (const bool back : {false, true}) {
    const std::size_t first = hull.size();
    for (const Vector2d& point : points) {
      while (hull.size() >= first + 2 &&
             cross_product(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    if (!back) std::ranges::reverse(points);
  }
  return hull;
}

bool is_within(const std::vector<Polyline>& outlines, const Vector2d& at) {
  bool is_in = false;
  for (const Polyline& line : outlines) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      const Vector2d &a = line[k], &b = line[(k + 1) % line.size()];
      if ((a.y() > at.y()) == (b.y() > at.y())) continue;
      const double x = a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (at.x() < x) is_in = !is_in;
    }
  }
  return is_in;
}

Polyline closed(Polyline outline) {
  outline.push_back(outline.front());
  return outline;
}

}  // namespace faultsim::grid_scene
