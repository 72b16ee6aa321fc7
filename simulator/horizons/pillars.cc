#include "simulator/horizons/pillars.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

/// What holds on pillars: on faults, and on sides of the box.
std::vector<std::vector<FieldRule>> pillar_rules(const LayeredBody& body, const MapMesh& map,
                                                 const std::vector<FaultShape>& shapes) {
  std::vector<std::vector<FieldRule>> rules(map.vertices.size());
  for (int f = 0; f < map.n_faults; ++f) {
    const FaultShape& shape = shapes[f];
    for (std::size_t k = 0; k < shape.n_vertices(); ++k)
      rules[map.lines[f][k]].push_back({shape.across(k) / shape.across(k).squaredNorm(), f, k});
  }
  for (std::size_t v = 0; v < map.vertices.size(); ++v)
    for (int axis = 0; axis < 2; ++axis) {
      const double at = map.vertices[v][axis];
      if (at == body.low[axis] || at == body.high[axis])
        rules[v].push_back({Vector2d::Unit(axis), -1, 0});
    }
  return rules;
}

/// Along a fault, where pillars slide.
Vector2d sliding(const FieldRule& rule) {
  return Vector2d(-rule.direction.y(), rule.direction.x()).normalized();
}

/// z ascending of all ends and bends of faults; close ones where pillars that slide bend too.
std::vector<double> knots_of(const LayeredBody& body, const std::vector<FaultShape>& shapes) {
  std::vector<double> knots = {body.base, body.top, body.trace_depth};
  bool is_alike = true;
  for (const FaultShape& shape : shapes) {
    knots.insert(knots.end(), shape.depths().begin(), shape.depths().end());
    is_alike = is_alike && shape.is_alike();
  }
  constexpr int kEven = 16;
  for (int k = 1; k < kEven && !is_alike; ++k)
    knots.push_back(body.base + (body.top - body.base) * k / kEven);
  std::ranges::sort(knots);
  drop_repeated(knots);
  return knots;
}

}  // namespace

Pillars::Pillars(const LayeredBody& body, const MapMesh& map)
    : vertices_(map.vertices),
      shapes_(fault_shapes(body, map)),
      field_(map, pillar_rules(body, map, shapes_)),
      depths_(knots_of(body, shapes_)) {
  for (std::size_t v = 0; v < vertices_.size(); ++v)
    is_put_back_.push_back(std::ranges::any_of(field_.rules(v), [&](const FieldRule& rule) {
      return rule.line >= 0 && !shapes_[rule.line].is_alike();
    }));
  for (const double z : depths_) moved_.push_back(moved_at(z));
}

/// What a rule says of a pillar that has moved: its fault's shift where it has slid to.
double Pillars::value(const FieldRule& rule, double z, const Vector2d& moved) const {
  if (rule.line < 0) return 0;
  const FaultShape& shape = shapes_[rule.line];
  return shape.shift(shape.along(rule.vertex) + sliding(rule).dot(moved), z);
}

/// A pillar's way put back on its faults at a depth, along which it may have slid. Where it is on
/// two, by Newton: its rules are straight where the profiles that it lies between stay the same.
/// Whether that found a place is for off_faults() to say.
Vector2d Pillars::on_faults(std::size_t vertex, double z, const Vector2d& moved) const {
  const std::vector<FieldRule>& rules = field_.rules(vertex);
  if (rules.size() == 1) {
    const Vector2d along = sliding(rules[0]);
    const Vector2d across = field_.fixed(vertex, {value(rules[0], z, moved), 0});
    return across + along * along.dot(moved);
  }
  constexpr int kSteps = 30;
  constexpr double kSmall = 1e-3, kEnough = 1e-11;  // m
  Vector2d at = moved;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix2d slope;
    Vector2d miss;
    for (int r = 0; r < 2; ++r) {
      const FieldRule& rule = rules[r];
      const Vector2d little = kSmall * sliding(rule);
      const double change = value(rule, z, at + little) - value(rule, z, at - little);
      miss[r] = rule.direction.dot(at) - value(rule, z, at);
      slope.row(r) = rule.direction - sliding(rule) * (change / (2 * kSmall));
    }
    const Vector2d way = slope.partialPivLu().solve(miss);
    at -= way;
    if (way.norm() < kEnough) break;
  }
  return at;
}

std::vector<Vector2d> Pillars::moved_at(double z) const {
  std::vector<Vector2d> fixed(vertices_.size(), Vector2d::Zero());
  for (std::size_t v = 0; v < fixed.size(); ++v) {
    const std::vector<FieldRule>& rules = field_.rules(v);
    if (rules.empty()) continue;
    const double second = rules.size() > 1 ? value(rules[1], z, Vector2d::Zero()) : 0;
    fixed[v] = field_.fixed(v, {value(rules[0], z, Vector2d::Zero()), second});
    if (is_put_back_[v] && rules.size() > 1) fixed[v] = on_faults(v, z, fixed[v]);
  }
  std::vector<Vector2d> moved = field_.solve(fixed);
  constexpr int kSweeps = 20;
  constexpr double kSame = 1e-2;  // m: what is left is put back with the pillar
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0;
    for (std::size_t v = 0; v < fixed.size(); ++v) {
      if (!is_put_back_[v] || field_.rules(v).size() > 1) continue;
      const Vector2d before = fixed[v];
      fixed[v] = field_.fixed(v, {value(field_.rules(v)[0], z, moved[v]), 0});
      most = std::max(most, (fixed[v] - before).norm());
    }
    if (most <= kSame) break;
    moved = field_.solve(fixed);
  }
  return moved;
}

PillarDepth Pillars::depth(double z) const {
  const auto next = std::ranges::upper_bound(depths_, z);
  const std::ptrdiff_t k =
      std::clamp<std::ptrdiff_t>(next - depths_.begin() - 1, 0, std::ssize(depths_) - 2);
  const double part = (z - depths_[k]) / (depths_[k + 1] - depths_[k]);
  return {z, static_cast<std::size_t>(k), std::clamp(part, 0.0, 1.0)};
}

Vector2d Pillars::in_map(int vertex, const PillarDepth& depth) const {
  const Vector2d &low = moved_[depth.knot][vertex], &high = moved_[depth.knot + 1][vertex];
  const Vector2d moved = low + depth.part * (high - low);
  if (!is_put_back_[vertex]) return vertices_[vertex] + moved;
  return vertices_[vertex] + on_faults(static_cast<std::size_t>(vertex), depth.z, moved);
}

double Pillars::off_faults(int vertex, double z) const {
  if (!is_put_back_[vertex]) return 0;
  const Vector2d moved = in_map(vertex, z) - vertices_[vertex];
  double most = 0;
  for (const FieldRule& rule : field_.rules(static_cast<std::size_t>(vertex))) {
    const double off = std::abs(rule.direction.dot(moved) - value(rule, z, moved));
    if (!(off <= most)) most = off;
  }
  return most;
}

Eigen::Vector3d Pillars::at(int vertex, double z) const {
  const Vector2d place = in_map(vertex, z);
  return {place.x(), place.y(), z};
}

}  // namespace faultsim::horizons
