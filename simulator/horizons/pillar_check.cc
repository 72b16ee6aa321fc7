#include "simulator/horizons/pillar_check.h"

#include <algorithm>
#include <array>
#include <limits>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/horizons/fault_shape.h"
#include "simulator/horizons/traces.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

/// Depths at which pillars are looked at: where they bend, and evenly between.
std::vector<double> depths_to_check(const LayeredBody& body, const Pillars& pillars) {
  std::vector<double> depths = pillars.depths();
  constexpr int kEven = 8;
  for (int k = 0; k <= kEven; ++k) depths.push_back(body.base + (body.top - body.base) * k / kEven);
  std::ranges::sort(depths);
  return depths;
}

std::string depth_place(const Vector2d& at, double z) {
  return "x " + decimal(at.x(), 1) + ", y " + decimal(at.y(), 1) + ", z " + decimal(z, 1) + " m";
}

/// Traces moved to other depths, each piece along its own direction.
class DepthCheck {
 public:
  DepthCheck(const LayeredBody& body, const MapMesh& map, std::vector<Problem>& problems)
      : body_(body), map_(map), shapes_(fault_shapes(body, map)), problems_(problems) {}
  void stays_in_box(int f) const;
  void do_not_cut(int f, int g) const;

 private:
  std::vector<Vector2d> line_at(int f, double z) const {
    std::vector<Vector2d> line;
    const FaultShape& shape = shapes_[f];
    for (std::size_t k = 0; k < shape.n_vertices(); ++k)
      line.push_back(map_.vertices[map_.lines[f][k]] + shape.across(k) * shape.shift_at(k, z));
    return line;
  }
  double inside(const Vector2d& at) const {
    return std::min((at - body_.low).minCoeff(), (body_.high - at).minCoeff());
  }
  std::string name(int f) const { return "\"" + body_.faults[f].name + "\""; }

  const LayeredBody& body_;
  const MapMesh& map_;
  std::vector<FaultShape> shapes_;
  std::vector<Problem>& problems_;
};

void DepthCheck::stays_in_box(int f) const {
  for (const double z : shapes_[f].depths()) {
    const std::vector<Vector2d> line = line_at(f, z);
    for (std::size_t k = 0; k < line.size(); ++k) {
      const bool is_on_edge = inside(map_.vertices[map_.lines[f][k]]) == 0;
      if (is_on_edge || inside(line[k]) > 0) continue;
      problems_.push_back({concat("/faults/", f), 0,
                           concat(name(f), " leaves the box at ", depth_place(line[k], z)),
                           "enlarge the box, let the fault end above, or make it steeper"});
      return;
    }
  }
}

/// A place where a point of `moving` passes a stretch of `other` on the way from one depth to the
/// next, or NaN: lines that pass as a whole, parallel ones, need not cross at any depth looked at.
Vector2d first_passing(const std::array<std::vector<Vector2d>, 2>& moving,
                       const std::array<std::vector<Vector2d>, 2>& other) {
  for (std::size_t i = 0; i < moving[0].size(); ++i)
    for (std::size_t j = 0; j + 1 < other[0].size(); ++j) {
      const Vector2d &a = other[0][j], &b = other[0][j + 1];
      const Vector2d its_way = (other[1][j] - a + other[1][j + 1] - b) / 2;
      const Vector2d at = crossing_of(moving[0][i], moving[1][i] - its_way, a, b);
      if (at.allFinite()) return at;
    }
  return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

/// Where two lines cross first, or NaN.
Vector2d first_crossing(const std::vector<Vector2d>& p, const std::vector<Vector2d>& q) {
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    for (std::size_t j = 0; j + 1 < q.size(); ++j) {
      const Vector2d at = crossing_of(p[i], p[i + 1], q[j], q[j + 1]);
      if (at.allFinite()) return at;
    }
  return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

void DepthCheck::do_not_cut(int f, int g) const {
  const auto is_of_other = [&](int v) { return contains(map_.lines[g], v); };
  if (std::ranges::any_of(map_.lines[f], is_of_other)) return;
  const double low = std::max(shapes_[f].depths().front(), shapes_[g].depths().front());
  const double high = std::min(shapes_[f].depths().back(), shapes_[g].depths().back());
  constexpr int kDepths = 16;
  std::array<std::vector<Vector2d>, 2> first, second;  // at the depth before, at this one
  for (int step = 0; step <= kDepths && low <= high; ++step) {
    const double z = low + (high - low) * step / kDepths;
    first = {std::move(first[1]), line_at(f, z)};
    second = {std::move(second[1]), line_at(g, z)};
    Vector2d at = first_crossing(first[1], second[1]);
    if (!at.allFinite() && step > 0) at = first_passing(first, second);
    if (!at.allFinite() && step > 0) at = first_passing(second, first);
    if (!at.allFinite()) continue;
    problems_.push_back(
        {concat("/faults/", f), 0,
         concat(name(f), " and ", name(g), " cut each other in depth, at ", depth_place(at, z)),
         "let one end above the other; where one fault truncates another in depth, give "
         "a mesh of your own"});
    return;
  }
}

}  // namespace

void check_faults_in_depth(const LayeredBody& body, const MapMesh& map,
                           std::vector<Problem>& problems) {
  const DepthCheck check(body, map, problems);
  for (int f = 0; f < map.n_faults; ++f) {
    check.stays_in_box(f);
    for (int g = 0; g < f; ++g) check.do_not_cut(f, g);
  }
}

void check_meetings(const LayeredBody& body, const MapMesh& map, const Pillars& pillars,
                    const std::vector<std::vector<double>>& z, std::vector<Problem>& problems) {
  const double most = 1e-6 * body.cells.at_faults;
  const auto first_off = [&](int v) {
    return std::ranges::find_if(z[v],
                                [&](double at) { return !(pillars.off_faults(v, at) <= most); });
  };
  for (int f = 0; f < map.n_faults; ++f)
    for (const int v : map.lines[f]) {
      const auto at = first_off(v);
      if (at == z[v].end()) continue;
      problems.push_back(
          {concat("/faults/", f), 0,
           concat("the line in which \"", body.faults[f].name, "\" meets another fault, at ",
                  map_place(map.vertices[v]), " at the depth of traces, is not found at z ",
                  decimal(*at, 1), " m"),
           "let them meet at a larger angle, or let their dips change less along "
           "their traces"});
      break;
    }
}

void check_pillars(const LayeredBody& body, const MapMesh& map, const Pillars& pillars,
                   std::vector<Problem>& problems) {
  const std::vector<double> depths = depths_to_check(body, pillars);
  const std::size_t n_before = problems.size();
  check_meetings(body, map, pillars, std::vector(map.vertices.size(), depths), problems);
  if (problems.size() > n_before) return;
  constexpr double kLeast = 0.1;
  double worst = kLeast, worst_z = 0;
  std::size_t count = 0;
  Vector2d place = Vector2d::Zero();
  std::vector<Vector2d> moved(map.vertices.size());
  for (const double z : depths) {
    for (std::size_t v = 0; v < moved.size(); ++v)
      moved[v] = pillars.in_map(static_cast<int>(v), z);
    for (const std::array<int, 3>& t : map.triangles) {
      const double drawn = cross_of(map.vertices[t[0]], map.vertices[t[1]], map.vertices[t[2]]);
      const double ratio = cross_of(moved[t[0]], moved[t[1]], moved[t[2]]) / drawn;
      if (ratio >= kLeast) continue;
      ++count;
      if (ratio >= worst) continue;
      worst = ratio;
      worst_z = z;
      place = (moved[t[0]] + moved[t[1]] + moved[t[2]]) / 3;
    }
  }
  if (count == 0) return;
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int f = 0; f < map.n_faults; ++f)
    for (const int v : map.lines[f]) {
      const double away = (pillars.in_map(v, worst_z) - place).norm();
      if (away >= least) continue;
      least = away;
      nearest = f;
    }
  problems.push_back({concat("/faults/", nearest), 0,
                      concat("pillars cross beside \"", body.faults[nearest].name, "\", worst at ",
                             depth_place(place, worst_z)),
                      "make the fault steeper, let it end above, keep faults that dip towards each "
                      "other apart, or "
                      "draw its end further from others and from the edge of the box"});
}

}  // namespace faultsim::horizons
