#include "simulator/horizons/map_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

constexpr int kRounds = 60;  // of refinement; about 20 are used
constexpr int kSmoothings = 8;
constexpr double kMostRadius = 0.72;  // circumradius over size; 0.58 of an equilateral triangle
constexpr double kMostSlender = 1.2;  // circumradius over shortest side: angles above 25 degrees
constexpr double kApart = 0.6;        // of points that one round adds, over the size

/// Points of the map while it is being triangulated.
class MapMesher {
 public:
  MapMesher(const LayeredBody& body, const MapLines& lines, std::vector<Problem>& problems);
  MapMesh run();

 private:
  struct Candidate {
    double badness;
    Vector2d at;
    double size;
  };

  int vertex_at(const Vector2d& at);
  void add_sides();
  std::vector<Vector2d> graded_points(const MapLine& line) const;
  std::vector<Vector2d> graded_between(const std::vector<Vector2d>& way) const;
  double size_at(const Vector2d& at) const;
  void triangulate();
  bool is_encroaching(const Vector2d& at, int a, int b) const {
    return (points_[a] - at).dot(points_[b] - at) < 0;
  }
  bool restore_lines();
  bool restore_piece(std::vector<int>& line, std::size_t k, const MapSide* side);
  bool split(std::vector<int>& line, std::size_t k, bool is_side);
  void drop_encroaching();
  bool refine();
  bool is_taken(const Vector2d& at) const;
  void smooth();
  void finish_rounds();
  void compact();

  const LayeredBody& body_;
  const MapLines& input_;
  std::vector<Problem>& problems_;
  std::vector<Vector2d> points_;
  std::vector<bool> is_free_, is_dead_;
  std::map<std::pair<double, double>, int> known_;
  std::vector<std::vector<int>> lines_;  ///< faults, dividers, then the four sides.
  Triangles triangles_;
  std::vector<MapSide> sides_;
};

MapMesher::MapMesher(const LayeredBody& body, const MapLines& lines, std::vector<Problem>& problems)
    : body_(body), input_(lines), problems_(problems) {
  for (const MapLine& line : lines.lines) {
    lines_.emplace_back();
    const bool is_fault = std::ssize(lines_) <= lines.n_faults;
    for (const Vector2d& p : is_fault ? line.points : graded_points(line))
      lines_.back().push_back(vertex_at(p));
  }
  add_sides();
}

int MapMesher::vertex_at(const Vector2d& at) {
  const auto [place, is_new] =
      known_.emplace(std::pair(at.x(), at.y()), static_cast<int>(points_.size()));
  if (is_new) {
    points_.push_back(at);
    is_free_.push_back(false);
    is_dead_.push_back(false);
  }
  return place->second;
}

double MapMesher::size_at(const Vector2d& at) const {
  double size = body_.cells.far;
  for (std::size_t k = 0; k < input_.lines.size(); ++k) {
    const double away = nearest_on_line(input_.lines[k].points, at).distance;
    const double there = input_.is_fault(static_cast<int>(k)) ? body_.cells.at_faults
                                                              : body_.cells.beside_dividers();
    size = std::min(size, there + body_.cells.growth * away);
  }
  return size;
}

/// A divider's points that are kept, and others between them as sizes say.
std::vector<Vector2d> MapMesher::graded_points(const MapLine& line) const {
  std::vector<Vector2d> points = {line.points.front()}, way = points;
  for (std::size_t k = 1; k < line.points.size(); ++k) {
    way.push_back(line.points[k]);
    if (!line.is_kept[k]) continue;
    const std::vector<Vector2d> between = graded_between(way);
    points.insert(points.end(), between.begin(), between.end());
    points.push_back(line.points[k]);
    way = {line.points[k]};
  }
  return points;
}

/// Points within a way that divide it as sizes say.
std::vector<Vector2d> MapMesher::graded_between(const std::vector<Vector2d>& way) const {
  constexpr std::size_t kSteps = 200;
  std::vector<double> along = {0};
  for (std::size_t k = 1; k < way.size(); ++k)
    along.push_back(along.back() + (way[k] - way[k - 1]).norm());
  const auto at = [&](double part) -> Vector2d {
    const double place = part * along.back();
    std::size_t k = 0;
    while (k + 2 < way.size() && along[k + 1] < place) ++k;
    return way[k] + (way[k + 1] - way[k]) * ((place - along[k]) / (along[k + 1] - along[k]));
  };
  std::array<double, kSteps + 1> cells = {0};
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double size = size_at(at((static_cast<double>(i) + 0.5) / kSteps));
    cells[i + 1] = cells[i] + along.back() / kSteps / size;
  }
  const int n = std::max(1, static_cast<int>(std::lround(cells.back())));
  std::vector<Vector2d> points;
  std::size_t i = 0;
  for (int k = 1; k < n; ++k) {
    const double want = cells.back() * k / n;
    while (cells[i + 1] < want) ++i;
    const double step = (want - cells[i]) / (cells[i + 1] - cells[i]);
    points.push_back(at((static_cast<double>(i) + step) / kSteps));
  }
  return points;
}

/// The sides of the box, from corner to corner over the ends of lines there, in graded pieces.
void MapMesher::add_sides() {
  const Vector2d &low = body_.low, &high = body_.high;
  const std::array<Vector2d, 4> corners = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  const std::vector<Vector2d> before = points_;
  for (std::size_t s = 0; s < 4; ++s) {
    const Vector2d &from = corners[s], &to = corners[(s + 1) % 4];
    const int across = s % 2 == 0 ? 1 : 0;
    std::vector<Vector2d> stops = {from, to};
    for (const Vector2d& p : before)
      if (p[across] == from[across] && p != from && p != to) stops.push_back(p);
    const Vector2d along = (to - from).normalized();
    std::ranges::sort(stops, {}, [&](const Vector2d& p) { return (p - from).dot(along); });
    std::vector<int> side = {vertex_at(stops.front())};
    for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
      for (Vector2d at : graded_between({stops[k], stops[k + 1]})) {
        at[across] = from[across];
        side.push_back(vertex_at(at));
      }
      side.push_back(vertex_at(stops[k + 1]));
    }
    lines_.push_back(std::move(side));
  }
}

void MapMesher::triangulate() {
  std::vector<Vector2d> alive;
  std::vector<int> number;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (is_dead_[k]) continue;
    alive.push_back(points_[k]);
    number.push_back(static_cast<int>(k));
  }
  triangles_ = delaunay(alive);
  for (std::array<int, 3>& t : triangles_)
    for (int& v : t) v = number[v];
  sides_ = sides_of(triangles_);
}

bool MapMesher::split(std::vector<int>& line, std::size_t k, bool is_side) {
  const Vector2d a = points_[line[k]], b = points_[line[k + 1]];
  if ((b - a).norm() < body_.cells.at_faults / 4) {
    if (problems_.empty())
      problems_.push_back(
          {is_side ? "/box" : "/faults", 0,
           concat("lines in the map come too close to each other at ", map_place((a + b) / 2)),
           "move them apart, or make cells at faults smaller"});
    return false;
  }
  line.insert(line.begin() + static_cast<std::ptrdiff_t>(k) + 1, vertex_at((a + b) / 2));
  return true;
}

/// Drops free points in the circle over a piece of a line; splits a piece that is still no side.
bool MapMesher::restore_piece(std::vector<int>& line, std::size_t k, const MapSide* side) {
  if (side == nullptr) return split(line, k, &line - lines_.data() >= std::ssize(input_.lines));
  bool has_dropped = false;
  for (const int t : {side->left, side->right}) {
    if (t < 0) continue;
    for (const int v : triangles_[t]) {
      if (v == side->a || v == side->b || !is_free_[v] || is_dead_[v]) continue;
      if (!is_encroaching(points_[v], side->a, side->b)) continue;
      is_dead_[v] = true;
      has_dropped = true;
    }
  }
  return has_dropped;
}

bool MapMesher::restore_lines() {
  bool has_changed = false;
  for (std::vector<int>& line : lines_)
    for (std::size_t k = line.size() - 1; k-- > 0;)
      has_changed |= restore_piece(line, k, find_side(sides_, line[k], line[k + 1]));
  return has_changed;
}

void MapMesher::drop_encroaching() {
  for (const std::vector<int>& line : lines_)
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      for (std::size_t v = 0; v < points_.size(); ++v)
        if (is_free_[v] && is_encroaching(points_[v], line[k], line[k + 1])) is_dead_[v] = true;
}

/// Whether a point may not be added there: outside, or in the circle over a piece of a line.
bool MapMesher::is_taken(const Vector2d& at) const {
  if (!((at - body_.low).minCoeff() > 0 && (body_.high - at).minCoeff() > 0)) return true;
  for (const std::vector<int>& line : lines_)
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      if (is_encroaching(at, line[k], line[k + 1])) return true;
  return false;
}

Vector2d centre_of_circle(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d p = b - a, q = c - a;
  const double d = 2 * (p.x() * q.y() - p.y() * q.x());
  return a + Vector2d(q.y() * p.squaredNorm() - p.y() * q.squaredNorm(),
                      p.x() * q.squaredNorm() - q.x() * p.squaredNorm()) /
                 d;
}

/// Adds centres of circles of triangles that are too large or too slender, the worst first.
bool MapMesher::refine() {
  std::vector<Candidate> candidates;
  for (const std::array<int, 3>& t : triangles_) {
    const Vector2d &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]];
    const Vector2d centre = centre_of_circle(a, b, c);
    const double radius = (a - centre).norm();
    const double shortest = std::min({(a - b).norm(), (b - c).norm(), (c - a).norm()});
    const double size = size_at((a + b + c) / 3);
    const double badness =
        std::max(radius / (kMostRadius * size), radius / (kMostSlender * shortest));
    if (badness > 1 && radius > 0.3 * size) candidates.push_back({badness, centre, size});
  }
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::badness);
  std::vector<Candidate> added;
  for (const Candidate& one : candidates) {
    const bool is_near = std::ranges::any_of(added, [&](const Candidate& other) {
      return (one.at - other.at).norm() < kApart * std::min(one.size, other.size);
    });
    if (is_near || is_taken(one.at)) continue;
    added.push_back(one);
    points_.push_back(one.at);
    is_free_.push_back(true);
    is_dead_.push_back(false);
  }
  return !added.empty();
}

/// Moves free points to the mean of their triangles' middles, small triangles counting as much as
/// sizes say they should.
void MapMesher::smooth() {
  std::vector<Vector2d> sum(points_.size(), Vector2d::Zero());
  std::vector<double> weight(points_.size(), 0);
  for (const std::array<int, 3>& t : triangles_) {
    const Vector2d middle = (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3;
    const double area = cross_of(points_[t[0]], points_[t[1]], points_[t[2]]);
    const double one = area / std::pow(size_at(middle), 3);
    for (const int v : t) {
      sum[v] += one * middle;
      weight[v] += one;
    }
  }
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (is_free_[v] && !is_dead_[v]) points_[v] = sum[v] / weight[v];
  drop_encroaching();
}

void MapMesher::finish_rounds() {
  for (int round = 0; round < kRounds && problems_.empty(); ++round) {
    triangulate();
    if (!restore_lines() && !refine()) return;
  }
}

void MapMesher::compact() {
  std::vector<int> number(points_.size(), -1);
  std::vector<Vector2d> kept;
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (is_dead_[v]) continue;
    number[v] = static_cast<int>(kept.size());
    kept.push_back(points_[v]);
  }
  points_ = std::move(kept);
  for (std::array<int, 3>& t : triangles_)
    for (int& v : t) v = number[v];
  for (std::vector<int>& line : lines_)
    for (int& v : line) v = number[v];
}

MapMesh MapMesher::run() {
  finish_rounds();
  for (int k = 0; k < kSmoothings && problems_.empty(); ++k) {
    smooth();
    triangulate();
  }
  do {  // Lines alone, so that what is smooth stays.
    triangulate();
  } while (problems_.empty() && restore_lines());
  MapMesh mesh;
  if (!problems_.empty()) return mesh;
  compact();
  mesh.vertices = points_;
  mesh.triangles = triangles_;
  mesh.lines.assign(lines_.begin(), lines_.end() - 4);
  for (const Vector2d& p : points_) mesh.size.push_back(size_at(p));
  mesh.n_faults = input_.n_faults;
  return mesh;
}

}  // namespace

std::vector<MapSide> sides_of(const Triangles& triangles) {
  std::map<std::pair<int, int>, MapSide> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t v = 0; v < 3; ++v) {
      const int from = triangles[t][v], to = triangles[t][(v + 1) % 3];
      const std::pair<int, int> ends = std::minmax(from, to);
      MapSide& side = sides.emplace(ends, MapSide{ends.first, ends.second}).first->second;
      (from < to ? side.left : side.right) = static_cast<int>(t);
    }
  std::vector<MapSide> all;
  all.reserve(sides.size());
  for (const auto& [ends, side] : sides) all.push_back(side);
  return all;
}

const MapSide* find_side(const std::vector<MapSide>& sides, int a, int b) {
  const std::pair<int, int> ends = std::minmax(a, b);
  const auto at = std::ranges::lower_bound(
      sides, ends, {}, [](const MapSide& side) { return std::pair(side.a, side.b); });
  return at != sides.end() && at->a == ends.first && at->b == ends.second ? &*at : nullptr;
}

MapMesh mesh_map(const LayeredBody& body, const MapLines& lines, std::vector<Problem>& problems) {
  return MapMesher(body, lines, problems).run();
}

}  // namespace faultsim::horizons
