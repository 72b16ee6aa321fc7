#include "simulator/horizons/drawn_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/horizons/fault_shape.h"
#include "simulator/horizons/traces.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Where a level plane cuts a side of a triangle, or a stick (its number twice).
using CutPlace = std::pair<int, int>;

Vector2d cut_between(const Vector3d& a, const Vector3d& b, double z) {
  return a.head<2>() + (b - a).head<2>() * ((z - a.z()) / (b.z() - a.z()));
}

/// A place on a stick; beyond its ends its first or last piece goes on.
Vector2d on_stick(const DrawnSurface& surface, const std::vector<int>& stick, double z) {
  std::size_t k = 0;
  while (k + 2 < stick.size() && surface.points[stick[k + 1]].z() > z) ++k;
  return cut_between(surface.points[stick[k]], surface.points[stick[k + 1]], z);
}

/// Stretches of level lines, to be joined at places that they share.
class LevelCut {
 public:
  LevelCut(const DrawnSurface& surface, double z) {
    for (std::size_t s = 0; s + 1 < surface.sticks.size(); ++s) {
      for (const std::size_t one : {s, s + 1}) {
        const CutPlace place(static_cast<int>(one), static_cast<int>(one));
        at_[place] = on_stick(surface, surface.sticks[one], z);
      }
      join({static_cast<int>(s), static_cast<int>(s)},
           {static_cast<int>(s) + 1, static_cast<int>(s) + 1});
    }
    for (const std::array<int, 3>& t : surface.triangles) cut(surface, t, z);
  }
  std::vector<LevelLine> lines();

 private:
  void cut(const DrawnSurface& surface, const std::array<int, 3>& triangle, double z);
  void join(const CutPlace& a, const CutPlace& b) {
    if (a == b || contains(next_[a], b)) return;  // without area, or there twice
    next_[a].push_back(b);
    next_[b].push_back(a);
  }
  LevelLine walk(CutPlace from, CutPlace to);

  std::map<CutPlace, Vector2d> at_;
  std::map<CutPlace, std::vector<CutPlace>> next_;
};

/// A corner at the level counts as below it, so that each line is cut once.
void LevelCut::cut(const DrawnSurface& surface, const std::array<int, 3>& triangle, double z) {
  std::vector<CutPlace> places;
  for (std::size_t v = 0; v < 3; ++v) {
    const auto [a, b] = std::minmax(triangle[v], triangle[(v + 1) % 3]);
    const Vector3d &first = surface.points[a], &second = surface.points[b];
    if ((first.z() > z) == (second.z() > z)) continue;
    places.emplace_back(a, b);
    at_[places.back()] = cut_between(first, second, z);
  }
  if (places.size() == 2) join(places[0], places[1]);
}

/// From a place over the next one to an end, a branch or back to the first.
LevelLine LevelCut::walk(CutPlace from, CutPlace to) {
  const CutPlace first = from;
  LevelLine line = {at_.at(from)};
  for (;;) {
    line.push_back(at_.at(to));
    std::erase(next_[from], to);
    std::vector<CutPlace>& others = next_[to];
    std::erase(others, from);
    if (to == first || others.size() != 1) return line;
    from = to;
    to = others.front();
  }
}

std::vector<LevelLine> LevelCut::lines() {
  std::vector<LevelLine> lines;
  std::vector<CutPlace> ends, all;
  for (const auto& [place, neighbours] : next_) {
    all.push_back(place);
    if (neighbours.size() != 2) ends.push_back(place);
  }
  for (const auto* starts : {&ends, &all})  // then what is left are rings
    for (const CutPlace& start : *starts)
      while (!next_[start].empty()) lines.push_back(walk(start, next_[start].front()));
  return lines;
}

double length_of(const LevelLine& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  return length;
}

/// Points at equal distances of about a cell from end to end.
LevelLine evenly(const LevelLine& line, double cell) {
  constexpr double kMost = 5000;  // more are far out of the box, which is said later
  const double length = length_of(line);
  const int n = static_cast<int>(std::lround(std::clamp(length / cell, 1.0, kMost)));
  LevelLine points = {line.front()};
  double before = 0;
  std::size_t piece = 0;
  for (int k = 1; k < n; ++k) {
    const double at = length * k / n;
    double next = before + (line[piece + 1] - line[piece]).norm();
    while (next < at && piece + 2 < line.size()) {
      before = next;
      ++piece;
      next = before + (line[piece + 1] - line[piece]).norm();
    }
    const double part = (at - before) / (next - before);
    points.push_back(line[piece] + part * (line[piece + 1] - line[piece]));
  }
  points.push_back(line.back());
  return points;
}

/// The points of a line, and others between them.
LevelLine with_points_between(const LevelLine& line, double cell) {
  LevelLine points = {line.front()};
  for (std::size_t k = 1; k < line.size(); ++k) {
    const LevelLine piece = evenly({line[k - 1], line[k]}, cell);
    points.insert(points.end(), piece.begin() + 1, piece.end());
  }
  return points;
}

class LineDrawer {
 public:
  LineDrawer(const DrawnSurface& surface, double trace_depth, double cell,
             const std::string& pointer, const std::string& name, std::vector<Problem>& problems)
      : surface_(surface),
        trace_depth_(trace_depth),
        cell_(cell),
        pointer_(pointer),
        name_("the surface of \"" + name + "\""),
        problems_(problems) {}

  SurfaceLines run(const std::vector<Vector2d>& trace);

 private:
  void complain(const std::string& what, const std::string& cure) {
    problems_.push_back({pointer_, 0, name_ + " " + what, cure});
  }
  std::string depth_of(double z) const { return "at a depth of " + decimal(-z, 1) + " m"; }
  void take_range();
  void take_given(const std::vector<Vector2d>& trace);
  void take_trace();
  double step() const;
  std::vector<double> depths() const;
  void take_profiles();
  std::vector<double> hits(const std::vector<LevelLine>& lines, std::size_t point, double z) const;
  std::optional<double> prolonged_shift(std::size_t point, double z) const;
  bool take_depth(double z);
  void face_right();

  const DrawnSurface& surface_;
  double trace_depth_, cell_;
  const std::string& pointer_;
  std::string name_;
  std::vector<Problem>& problems_;
  SurfaceLines made_;
  std::vector<Vector2d> across_;  ///< per point of the trace, as FaultShape has it.
  bool bends_round_ = false;      ///< the trace, by more than a quarter of a turn.
};

void LineDrawer::take_range() {
  made_.top = -std::numeric_limits<double>::infinity();
  made_.bottom = -made_.top;
  for (const Vector3d& at : surface_.points) {
    made_.top = std::max(made_.top, at.z());
    made_.bottom = std::min(made_.bottom, at.z());
  }
  if (trace_depth_ >= made_.top || trace_depth_ <= made_.bottom) {
    complain(
        concat("reaches from ", decimal(-made_.top, 1), " to ", decimal(-made_.bottom, 1),
               " m depth and is not cut by the depth of traces, ", decimal(-trace_depth_, 1), " m"),
        "give a trace_depth that all faults reach, or a surface that reaches it");
  } else if (made_.top - made_.bottom < cell_) {
    complain("is lower than a cell", "give a taller surface, or smaller cells");
  }
}

void LineDrawer::take_trace() {
  std::vector<LevelLine> lines = level_lines(surface_, trace_depth_);
  std::ranges::sort(
      lines, [](const LevelLine& a, const LevelLine& b) { return length_of(a) > length_of(b); });
  std::erase_if(lines, [&](const LevelLine& line) { return length_of(line) < 1e-6 * cell_; });
  const std::string here = "the depth of traces, " + decimal(-trace_depth_, 1) + " m";
  if (lines.empty() || length_of(lines[0]) < cell_)
    return complain("is less than a cell long at " + here, "give a longer one, or a trace");
  if ((lines[0].front() - lines[0].back()).norm() < 1e-6 * cell_)
    return complain(concat("is a ring at ", here, ", around ", map_place(lines[0].front())),
                    "split it into two faults, or give a trace");
  if (lines.size() > 1)
    return complain(concat("is cut along ", lines.size(), " lines at ", here, ", one of them at ",
                           map_place(lines[1].front())),
                    "close its holes, split it into faults, or give a trace");
  made_.trace = evenly(lines[0], cell_);
}

/// Points at one place count once, as where traces meet.
void LineDrawer::take_given(const std::vector<Vector2d>& trace) {
  constexpr double kSamePlace = 1e-6;  // of a cell
  LevelLine line;
  for (const Vector2d& at : trace)
    if (line.empty() || (at - line.back()).norm() > kSamePlace * cell_) line.push_back(at);
  if (line.size() < 2)
    return complain("is given a trace that has no length",
                    "give it two or more points, or leave it out");
  made_.trace = with_points_between(line, cell_);
}

/// Between depths: a cell, if that makes no more than so many.
double LineDrawer::step() const {
  constexpr int kMost = 200;
  return std::max(cell_, (made_.top - made_.bottom) / kMost);
}

/// At the depth of traces, and from there a step apart; at its ends a little inside.
std::vector<double> LineDrawer::depths() const {
  constexpr double kInside = 1e-9;
  const double height = made_.top - made_.bottom, step = this->step();
  std::vector<double> depths = {trace_depth_};
  for (const double end : {made_.top - kInside * height, made_.bottom + kInside * height}) {
    const double way = end < trace_depth_ ? -1 : 1;
    for (int k = 1; k * step < std::abs(end - trace_depth_) - step / 2; ++k)
      depths.push_back(trace_depth_ + way * k * step);
    depths.push_back(end);
  }
  return depths;
}

/// Where lines meet the vertical plane through `at` across n: m along n, ascending.
std::vector<double> crossings(const std::vector<LevelLine>& lines, const Vector2d& at,
                              const Vector2d& n) {
  std::vector<double> found;
  for (const LevelLine& line : lines)
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Vector2d a = line[k] - at, b = line[k + 1] - at;
      const double a_along = n.x() * a.y() - n.y() * a.x(), b_along = n.x() * b.y() - n.y() * b.x();
      if (a_along * b_along > 0 || a_along == b_along) continue;
      found.push_back((a + (b - a) * (a_along / (a_along - b_along))).dot(n));
    }
  std::ranges::sort(found);
  return found;
}

/// By how much the directions of a line differ at most, rad: 2 pi and more of a spiral.
double turn_of(const LevelLine& line) {
  double angle = 0, least = 0, most = 0;
  for (std::size_t k = 1; k + 1 < line.size(); ++k) {
    const Vector2d before = line[k] - line[k - 1], after = line[k + 1] - line[k];
    angle += std::atan2(before.x() * after.y() - before.y() * after.x(), before.dot(after));
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  return most - least;
}

/// Whether a place across a point of a trace belongs to another part of it: a trace that bends
/// round lies across itself.
bool is_of_another_part(const LevelLine& trace, const Vector2d& point, const Vector2d& place,
                        double cell) {
  return nearest_on_line(trace, place).distance < (place - point).norm() / 2 - cell;
}

/// A line with its first and last piece made longer.
LevelLine prolonged(LevelLine line, double by) {
  const std::size_t n = line.size();
  line[0] += by * (line[0] - line[1]).normalized();
  line[n - 1] += by * (line[n - 1] - line[n - 2]).normalized();
  return line;
}

/// Shifts at a point of the trace where lines at a depth lie across it; a line may end a cell
/// before it. None further away than surfaces of five degrees are.
std::vector<double> LineDrawer::hits(const std::vector<LevelLine>& lines, std::size_t point,
                                     double z) const {
  constexpr double kFlattest = 11.5;
  const double reach = kFlattest * std::abs(z - trace_depth_) + 2 * cell_;
  const Vector2d &at = made_.trace[point], n = across_[point].normalized();
  const auto here = [&](const std::vector<LevelLine>& of) {
    std::vector<double> found = crossings(of, at, n);
    std::erase_if(found, [&](double shift) {
      return std::abs(shift) > reach ||
             (bends_round_ && is_of_another_part(made_.trace, at, at + shift * n, cell_));
    });
    return mapped(found, [&](double shift) { return shift / across_[point].norm(); });
  };
  const std::vector<double> found = here(lines);
  if (!found.empty()) return found;
  return here(mapped(lines, [&](const LevelLine& line) { return prolonged(line, cell_); }));
}

/// Where the surface does not reach a depth, a profile that is known nearer to the trace goes on
/// straight.
std::optional<double> LineDrawer::prolonged_shift(std::size_t point, double z) const {
  DipProfile known = made_.profiles[point];
  if (known.size() < 2) return std::nullopt;
  std::ranges::sort(known, {}, [&](const DipPoint& one) { return std::abs(one.z - z); });
  const double slope = (known[0].shift - known[1].shift) / (known[0].z - known[1].z);
  return known[0].shift + slope * (z - known[0].z);
}

/// Adds a point to all profiles. @returns false where the surface folds back, or is not at the
/// trace.
bool LineDrawer::take_depth(double z) {
  constexpr double kSame = 0.02;  // of a cell
  const std::vector<LevelLine> lines = level_lines(surface_, z);
  std::vector<std::optional<double>> shifts;
  bool is_reached = false;
  for (std::size_t k = 0; k < made_.trace.size(); ++k) {
    const std::vector<double> here = hits(lines, k, z);
    shifts.push_back(here.empty() ? std::nullopt : std::optional(here.front()));
    is_reached = is_reached || !here.empty();
    if (here.empty() || here.back() - here.front() < kSame * cell_) continue;
    complain(concat("lies in two places ", depth_of(z), " across ", map_place(made_.trace[k]),
                    ": it folds back"),
             "give only the part of it that goes down");
    return false;
  }
  if (!is_reached && z == trace_depth_)
    complain("is nowhere near the trace that is given",
             "leave the trace out, or draw it on the surface");
  if (!is_reached) return z != trace_depth_;
  for (std::size_t k = 0; k < shifts.size(); ++k) {
    if (shifts[k]) {
      auto& [low, high] = made_.reached[k];
      low = std::min(low, std::max(z - step(), made_.bottom));
      high = std::max(high, std::min(z + step(), made_.top));
    } else {
      if (const std::optional<double> straight = prolonged_shift(k, z)) {
        made_.profiles[k].push_back({z, *straight});
        continue;
      }
    }
    std::size_t nearest = k;
    for (std::size_t away = 0; !shifts[nearest]; ++away)
      nearest = k >= away && shifts[k - away] ? k - away : std::min(k + away, shifts.size() - 1);
    made_.profiles[k].push_back({z, *shifts[nearest]});
  }
  return true;
}

void LineDrawer::take_profiles() {
  LayeredFault bare;
  bare.trace = made_.trace;
  LayeredBody body;
  body.top = made_.top;
  body.base = made_.bottom;
  const FaultShape shape(body, bare, made_.trace);
  for (std::size_t k = 0; k < made_.trace.size(); ++k) across_.push_back(shape.across(k));
  bends_round_ = turn_of(made_.trace) > std::numbers::pi / 2;
  made_.profiles.resize(made_.trace.size());
  made_.reached.assign(made_.trace.size(), {made_.top, made_.bottom});
  for (const double z : depths())
    if (!take_depth(z)) return;
  if (made_.profiles[0].size() < 2)
    complain("has no line down it", "give one that goes down from its trace");
}

/// The fault dips to the right of its trace, or is vertical and runs to larger y.
void LineDrawer::face_right() {
  double right = 0, down = 0;
  for (const DipProfile& profile : made_.profiles)
    for (std::size_t k = 1; k < profile.size(); ++k) {
      right += (profile[k].shift - profile[0].shift) * (profile[0].z - profile[k].z > 0 ? 1 : -1);
      down += std::abs(profile[0].z - profile[k].z);
    }
  constexpr double kVertical = 0.01;
  const Vector2d way = made_.trace.back() - made_.trace.front();
  const bool is_north = way.y() > 0 || (way.y() == 0 && way.x() > 0);
  if (std::abs(right) < kVertical * down ? is_north : right > 0) return;
  std::ranges::reverse(made_.trace);
  std::ranges::reverse(made_.profiles);
  std::ranges::reverse(made_.reached);
  for (DipProfile& profile : made_.profiles)
    for (DipPoint& point : profile) point.shift = -point.shift;
}

SurfaceLines LineDrawer::run(const std::vector<Vector2d>& trace) {
  const std::size_t n_before = problems_.size();
  take_range();
  if (problems_.size() > n_before) return std::move(made_);
  if (trace.empty()) take_trace();
  if (!trace.empty()) take_given(trace);
  if (problems_.size() > n_before) return std::move(made_);
  take_profiles();
  if (problems_.size() == n_before && trace.empty()) face_right();
  return std::move(made_);
}

}  // namespace

std::vector<LevelLine> level_lines(const DrawnSurface& surface, double z) {
  return LevelCut(surface, z).lines();
}

SurfaceLines lines_of(const DrawnSurface& surface, const std::vector<Vector2d>& trace,
                      double trace_depth, double cell, const std::string& pointer,
                      const std::string& name, std::vector<Problem>& problems) {
  return LineDrawer(surface, trace_depth, cell, pointer, name, problems).run(trace);
}

}  // namespace faultsim::horizons
