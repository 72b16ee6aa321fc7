#include "simulator/horizons/traces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/horizons/delaunay.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

constexpr double kSamePlace = 1e-6;  // of a cell
constexpr double kTaken = 0.05;      // of a cell: a point this near is taken for another
constexpr double kLeastAngle =
    25 * std::numbers::pi / 180;  // below it cells between two lines are slivers
constexpr double kBend = 5 * std::numbers::pi / 180;  // a point where a line turns more is kept

/// The lines while they are being joined.
class LineJoiner {
 public:
  LineJoiner(const LayeredBody& body, std::vector<Problem>& problems)
      : body_(body), problems_(problems), cell_(body.cells.at_faults) {}

  MapLines run();

 private:
  struct Meeting {
    Vector2d at;
    int first, second;  ///< lines; second −1: a side of the box.
  };

  void add(const std::string& name, const std::vector<Vector2d>& points, const std::string& what);
  void join_end(int line, bool is_last, TraceEnd end);
  void join_to_box(int line, Vector2d& end);
  void join_to_line(int line, bool is_last, Vector2d& end);
  void drop_overshoot(int line, bool is_last, int other);
  void check_tip(int line, const Vector2d& end);
  void cross_all();
  void cross(int p, int q);
  Vector2d put_on(int line, const Vector2d& at);
  void check_meetings();
  void check_angle(const Meeting& meeting);
  void check_company(const Meeting& meeting);
  void check_spacing(int line);
  void take_points(MapLine& line) const;
  void mark_kept(MapLine& line) const;
  void complain(int line, const std::string& what, const std::string& cure) {
    problems_.push_back({pointer(line), 0, what, cure});
  }
  std::string pointer(int line) const {
    return line < all_.n_faults ? concat("/faults/", line, "/trace")
                                : concat("/dividers/", line - all_.n_faults, "/line");
  }
  bool is_meeting(const Vector2d& at) const {
    return std::ranges::any_of(meetings_, [&](const Meeting& m) { return m.at == at; });
  }

  const LayeredBody& body_;
  std::vector<Problem>& problems_;
  double cell_;
  MapLines all_;
  std::vector<Meeting> meetings_;
  std::vector<Vector2d> refused_tips_;  ///< too close to another line.
};

void LineJoiner::add(const std::string& name, const std::vector<Vector2d>& points,
                     const std::string& what) {
  const auto number = static_cast<int>(all_.lines.size());
  MapLine line{name, {}, {}};
  for (const Vector2d& p : points) {
    const Vector2d outside = (body_.low - p).cwiseMax(p - body_.high);
    if (!p.allFinite() || outside.maxCoeff() > cell_) {
      complain(number, concat(what, " \"", name, "\" leaves the box at ", map_place(p)),
               "end it at the edge, or enlarge the box");
      break;
    }
    if (line.points.empty() || (p - line.points.back()).norm() > kSamePlace * cell_)
      line.points.push_back(p.cwiseMax(body_.low).cwiseMin(body_.high));
  }
  if (points.size() < 2 || line.points.size() < 2)
    complain(number, concat(what, " \"", name, "\" has no length"), "give two or more points");
  all_.lines.push_back(std::move(line));
}

void LineJoiner::join_to_box(int line, Vector2d& end) {
  int axis = 0;
  double side = 0, least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 2; ++a)
    for (const double at : {body_.low[a], body_.high[a]})
      if (std::abs(end[a] - at) < least) {
        least = std::abs(end[a] - at);
        axis = a;
        side = at;
      }
  if (least > cell_) {
    complain(line,
             concat("\"", all_.lines[line].name, "\" is to end at the edge of the box but ends ",
                    decimal(least, 1), " m short of it, at ", map_place(end)),
             "extend it to the edge, or let it end in the rock");
    return;
  }
  end[axis] = side;
  meetings_.push_back({end, line, -1});
}

/// A point of a line at a place on it; one that is there already is taken instead.
Vector2d LineJoiner::put_on(int line, const Vector2d& at) {
  std::vector<Vector2d>& points = all_.lines[line].points;
  const NearestOnLine nearest = nearest_on_line(points, at);
  for (const std::size_t k : {nearest.segment, nearest.segment + 1})
    if ((points[k] - nearest.point).norm() <= kTaken * cell_) return points[k];
  points.insert(points.begin() + static_cast<std::ptrdiff_t>(nearest.segment) + 1, nearest.point);
  return nearest.point;
}

/// Of the points by which a line goes past the one it is to end at only the last is left, which is
/// moved back to it: by the others it would cross it and return.
void LineJoiner::drop_overshoot(int line, bool is_last, int other) {
  std::vector<Vector2d>& points = all_.lines[line].points;
  const std::vector<Vector2d>& past = all_.lines[other].points;
  if (!is_last) std::ranges::reverse(points);
  std::size_t first = points.size() - 1;
  for (std::size_t k = first; k > 0; --k) {
    if (nearest_on_line(past, points[k]).distance > cell_) break;
    for (std::size_t j = 0; j + 1 < past.size(); ++j)
      if (crossing_of(points[k - 1], points[k], past[j], past[j + 1]).allFinite()) first = k;
  }
  points.erase(points.begin() + static_cast<std::ptrdiff_t>(first), points.end() - 1);
  if (!is_last) std::ranges::reverse(points);
}

void LineJoiner::join_to_line(int line, bool is_last, Vector2d& end) {
  int other = -1;
  NearestOnLine nearest{std::numeric_limits<double>::infinity(), end, 0};
  for (int q = 0; q < static_cast<int>(all_.lines.size()); ++q) {
    if (q == line || (all_.is_fault(line) && !all_.is_fault(q))) continue;
    const NearestOnLine one = nearest_on_line(all_.lines[q].points, end);
    if (one.distance < nearest.distance) {
      nearest = one;
      other = q;
    }
  }
  const std::string name = "\"" + all_.lines[line].name + "\"";
  if (nearest.distance > cell_) {
    complain(
        line,
        concat(name, " is to end at another fault but ends at ", map_place(end), ", near none"),
        "extend it to the fault, or let it end in the rock");
    return;
  }
  const std::vector<Vector2d>& points = all_.lines[other].points;
  const bool is_v = std::ranges::any_of(
      std::array<Vector2d, 2>{points.front(), points.back()}, [&](const Vector2d& tip) {
        const Vector2d from_side = (tip - body_.low).cwiseMin(body_.high - tip);
        return (tip - nearest.point).norm() < cell_ && from_side.minCoeff() > 0;
      });
  if (is_v && all_.is_fault(line)) {
    complain(line,
             concat(name, " and \"", all_.lines[other].name, "\" end at each other at ",
                    map_place(nearest.point), " (a V)"),
             "draw them as one fault with a bend, or let one extend past the other by a cell");
    return;
  }
  drop_overshoot(line, is_last, other);
  end = put_on(other, nearest.point);
  meetings_.push_back({end, line, other});
}

void LineJoiner::check_tip(int line, const Vector2d& end) {
  for (int q = 0; q < static_cast<int>(all_.lines.size()); ++q) {
    const bool ends_here = std::ranges::any_of(
        meetings_, [&](const Meeting& m) { return m.first == q && m.at == end; });
    // A divider may pass through the tip.
    const bool has_tip = !all_.is_fault(q) && contains(all_.lines[q].points, end);
    if (q == line || ends_here || has_tip) continue;
    if (nearest_on_line(all_.lines[q].points, end).distance > 0.5 * cell_) continue;
    refused_tips_.push_back(end);
    complain(line,
             concat("\"", all_.lines[line].name, "\" ends in the rock at ", map_place(end),
                    ", less than half a cell from \"", all_.lines[q].name, "\""),
             concat(all_.is_fault(q) ? "let it end at \"" : "let the tip be a point of \"",
                    all_.lines[q].name, "\", or keep a cell between"));
  }
  const Vector2d from_side = (end - body_.low).cwiseMin(body_.high - end);
  if (from_side.minCoeff() < 0.5 * cell_)
    complain(line,
             concat("\"", all_.lines[line].name, "\" ends in the rock at ", map_place(end),
                    ", less than half a cell from the edge of the box"),
             "let it end at the edge, or enlarge the box");
}

void LineJoiner::join_end(int line, bool is_last, TraceEnd end) {
  // By value: what the end is joined to may be this vector's neighbour, never itself.
  Vector2d at = is_last ? all_.lines[line].points.back() : all_.lines[line].points.front();
  if (end == TraceEnd::at_edge) join_to_box(line, at);
  if (end == TraceEnd::at_fault) join_to_line(line, is_last, at);
  (is_last ? all_.lines[line].points.back() : all_.lines[line].points.front()) = at;
}

void LineJoiner::cross(int p, int q) {
  const std::vector<Vector2d> first = all_.lines[p].points, second = all_.lines[q].points;
  for (std::size_t i = 0; i + 1 < first.size(); ++i)
    for (std::size_t j = 0; j + 1 < second.size(); ++j) {
      const Vector2d at = crossing_of(first[i], first[i + 1], second[j], second[j + 1]);
      const auto is_near = [&](const Vector2d& place) {
        return (place - at).norm() <= kTaken * cell_;
      };
      if (!at.allFinite() || std::ranges::any_of(refused_tips_, is_near)) continue;
      const bool is_known = std::ranges::any_of(meetings_, [&](const Meeting& m) {
        const bool is_theirs = (m.first == p && m.second == q) || (m.first == q && m.second == p);
        return is_theirs && (m.at - at).norm() < cell_;
      });
      if (is_known) continue;
      Vector2d shared = put_on(p, at);
      const NearestOnLine there = nearest_on_line(all_.lines[q].points, shared);
      std::vector<Vector2d>& points = all_.lines[q].points;
      std::size_t near_point = there.segment;
      if ((points[near_point + 1] - shared).norm() < (points[near_point] - shared).norm())
        ++near_point;
      const bool is_inner = near_point > 0 && near_point + 1 < points.size();
      if (is_inner && (points[near_point] - shared).norm() <= kTaken * cell_)
        points[near_point] = shared;
      else
        points.insert(points.begin() + static_cast<std::ptrdiff_t>(there.segment) + 1, shared);
      meetings_.push_back({shared, p, q});
    }
}

void LineJoiner::cross_all() {
  const auto n = static_cast<int>(all_.lines.size());
  for (int p = 0; p < n; ++p)
    for (int q = p + 1; q < n; ++q) cross(p, q);
}

/// Directions of a line away from one of its points.
std::vector<Vector2d> directions_at(const MapLine& line, const Vector2d& at) {
  std::vector<Vector2d> away;
  const std::vector<Vector2d>& points = line.points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k] != at) continue;
    if (k > 0) away.push_back((points[k - 1] - at).normalized());
    if (k + 1 < points.size()) away.push_back((points[k + 1] - at).normalized());
  }
  return away;
}

void LineJoiner::check_angle(const Meeting& meeting) {
  const std::vector<Vector2d> own = directions_at(all_.lines[meeting.first], meeting.at);
  std::vector<Vector2d> others;
  std::string other = "the edge of the box";
  if (meeting.second >= 0) {
    others = directions_at(all_.lines[meeting.second], meeting.at);
    other = "\"" + all_.lines[meeting.second].name + "\"";
  } else {
    const bool on_x = meeting.at.x() == body_.low.x() || meeting.at.x() == body_.high.x();
    const bool on_y = meeting.at.y() == body_.low.y() || meeting.at.y() == body_.high.y();
    if (on_x) others.insert(others.end(), {Vector2d::UnitY(), -Vector2d::UnitY()});
    if (on_y) others.insert(others.end(), {Vector2d::UnitX(), -Vector2d::UnitX()});
  }
  double least = std::numbers::pi;
  for (const Vector2d& a : own)
    for (const Vector2d& b : others) least = std::min(least, std::acos(std::min(1.0, a.dot(b))));
  if (least >= kLeastAngle) return;
  complain(
      meeting.first,
      concat("\"", all_.lines[meeting.first].name, "\" meets ", other, " at ",
             std::round(least * 180 / std::numbers::pi), " degrees at ", map_place(meeting.at)),
      "let them meet at 25 degrees or more, or draw both as one fault");
}

/// A pillar can lie on two surfaces, not on three.
void LineJoiner::check_company(const Meeting& meeting) {
  int n_walls = 0;
  for (int axis = 0; axis < 2; ++axis)
    n_walls += meeting.at[axis] == body_.low[axis] || meeting.at[axis] == body_.high[axis];
  for (int f = 0; f < all_.n_faults; ++f) n_walls += contains(all_.lines[f].points, meeting.at);
  if (n_walls > 2)
    complain(
        meeting.first,
        concat("three faults, or two and the edge of the box, meet at ", map_place(meeting.at)),
        "keep a cell between the places where two of them meet");
}

void LineJoiner::check_spacing(int line) {
  const MapLine& one = all_.lines[line];
  const Vector2d* last = nullptr;
  for (std::size_t k = 0; k < one.points.size(); ++k) {
    if (!is_meeting(one.points[k])) continue;
    if (last != nullptr && (*last - one.points[k]).norm() < 0.5 * cell_)
      complain(
          line,
          concat("\"", one.name, "\" meets two others within half a cell at ", map_place(*last)),
          "keep a cell between them, or make cells at faults smaller");
    last = &one.points[k];
  }
}

void LineJoiner::check_meetings() {
  for (const Meeting& meeting : meetings_) check_angle(meeting);
  for (const Meeting& meeting : meetings_) check_company(meeting);
  for (int line = 0; line < static_cast<int>(all_.lines.size()); ++line) check_spacing(line);
}

void LineJoiner::mark_kept(MapLine& line) const {
  const std::size_t n = line.points.size();
  line.is_kept.assign(n, false);
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 0 || k + 1 == n || is_meeting(line.points[k])) {
      line.is_kept[k] = true;
      continue;
    }
    const Vector2d before = (line.points[k] - line.points[k - 1]).normalized();
    const Vector2d after = (line.points[k + 1] - line.points[k]).normalized();
    line.is_kept[k] = before.dot(after) < std::cos(kBend);
  }
}

/// Replaces the points between those that are kept by others at equal distances along the line.
void LineJoiner::take_points(MapLine& line) const {
  MapLine taken{line.name, {line.points.front()}, {true}};
  for (std::size_t from = 0; from + 1 < line.points.size();) {
    std::vector<double> along = {0};
    std::size_t to = from;
    do {
      along.push_back(along.back() + (line.points[to + 1] - line.points[to]).norm());
      ++to;
    } while (!line.is_kept[to]);
    const int n = std::max(1, static_cast<int>(std::lround(along.back() / cell_)));
    std::size_t piece = 0;
    for (int k = 1; k < n; ++k) {
      const double at = along.back() * k / n;
      while (along[piece + 1] < at) ++piece;
      const double part = (at - along[piece]) / (along[piece + 1] - along[piece]);
      const Vector2d &a = line.points[from + piece], &b = line.points[from + piece + 1];
      taken.points.push_back(a + part * (b - a));
      taken.is_kept.push_back(false);
    }
    taken.points.push_back(line.points[to]);
    taken.is_kept.push_back(true);
    from = to;
  }
  line = std::move(taken);
}

MapLines LineJoiner::run() {
  all_.n_faults = static_cast<int>(body_.faults.size());
  for (const LayeredFault& fault : body_.faults) add(fault.name, fault.trace, "the trace of");
  for (const Divider& divider : body_.dividers) add(divider.name, divider.line, "the divider");
  if (!problems_.empty()) return std::move(all_);
  for (int f = 0; f < all_.n_faults; ++f) {
    join_end(f, false, body_.faults[f].first_end);
    join_end(f, true, body_.faults[f].last_end);
  }
  for (int d = all_.n_faults; d < static_cast<int>(all_.lines.size()); ++d) {
    for (const bool is_last : {false, true}) {
      const Vector2d at = is_last ? all_.lines[d].points.back() : all_.lines[d].points.front();
      const Vector2d from_side = (at - body_.low).cwiseMin(body_.high - at);
      join_end(d, is_last, from_side.minCoeff() < cell_ ? TraceEnd::at_edge : TraceEnd::at_fault);
    }
  }
  if (!problems_.empty()) return std::move(all_);
  // Before crossings are found, as a tip on another line would be one.
  for (int f = 0; f < all_.n_faults; ++f) {
    if (body_.faults[f].first_end == TraceEnd::in_rock) check_tip(f, all_.lines[f].points.front());
    if (body_.faults[f].last_end == TraceEnd::in_rock) check_tip(f, all_.lines[f].points.back());
  }
  cross_all();
  check_meetings();
  for (int line = 0; problems_.empty() && line < static_cast<int>(all_.lines.size()); ++line) {
    mark_kept(all_.lines[line]);
    if (all_.is_fault(line)) take_points(all_.lines[line]);
  }
  return std::move(all_);
}

}  // namespace

std::string map_place(const Vector2d& at) {
  return "x " + decimal(at.x(), 1) + ", y " + decimal(at.y(), 1) + " m";
}

NearestOnLine nearest_on_line(const std::vector<Vector2d>& line, const Vector2d& place) {
  NearestOnLine nearest{std::numeric_limits<double>::infinity(), line.front(), 0};
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vector2d along = line[k + 1] - line[k];
    const double part = std::clamp((place - line[k]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const Vector2d at = line[k] + part * along;
    const double distance = (place - at).norm();
    if (distance < nearest.distance) nearest = {distance, at, k};
  }
  return nearest;
}

Vector2d crossing_of(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double c_side = cross_of(a, b, c), d_side = cross_of(a, b, d);
  const double a_side = cross_of(c, d, a), b_side = cross_of(c, d, b);
  const bool is_apart = c_side * d_side > 0 || a_side * b_side > 0 || c_side == d_side;
  if (is_apart) return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return c + (d - c) * (c_side / (c_side - d_side));
}

MapLines meeting_lines(const LayeredBody& body, std::vector<Problem>& problems) {
  return LineJoiner(body, problems).run();
}

}  // namespace faultsim::horizons
