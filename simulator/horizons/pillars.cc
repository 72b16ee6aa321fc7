#include "simulator/horizons/pillars.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/horizons/map_operator.h"

namespace faultsim::horizons {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// direction · W = 1 of the fault `line`, 0 of others; a side of the box is line −1.
struct PillarRule {
  Vector2d direction;
  int line;
};

std::vector<std::vector<PillarRule>> pillar_rules(const LayeredBody& body, const MapMesh& map) {
  std::vector<std::vector<PillarRule>> rules(map.vertices.size());
  for (int f = 0; f < map.n_faults; ++f) {
    const std::vector<Vector2d> along = hanging_directions(body.faults[f], map, f);
    for (std::size_t k = 0; k < along.size(); ++k)
      rules[map.lines[f][k]].push_back({along[k] / along[k].squaredNorm(), f});
  }
  for (std::size_t v = 0; v < map.vertices.size(); ++v)
    for (int axis = 0; axis < 2; ++axis) {
      const double at = map.vertices[v][axis];
      if (at == body.low[axis] || at == body.high[axis])
        rules[v].push_back({Vector2d::Unit(axis), -1});
    }
  return rules;
}

/// W = basis q + fixed at a vertex, q of as many components as are free.
struct FreedomAtVertex {
  Eigen::Matrix2d basis = Eigen::Matrix2d::Identity();
  int n_free = 2;
  int first = 0;  ///< its first unknown.

  /// Of the first two rules.
  explicit FreedomAtVertex(const std::vector<PillarRule>& rules) {
    if (rules.empty()) return;
    const Vector2d n = rules[0].direction.normalized();
    basis.col(0) = Vector2d(-n.y(), n.x());
    n_free = rules.size() == 1 ? 1 : 0;
  }
};

Vector2d fixed_part(const std::vector<PillarRule>& rules, int fault) {
  const auto value = [&](const PillarRule& rule) { return rule.line == fault ? 1.0 : 0.0; };
  if (rules.empty()) return Vector2d::Zero();
  const Vector2d& n = rules[0].direction;
  if (rules.size() == 1) return n * (value(rules[0]) / n.squaredNorm());
  Eigen::Matrix2d both;
  both << n.transpose(), rules[1].direction.transpose();
  return both.partialPivLu().solve(Vector2d(value(rules[0]), value(rules[1])));
}

/// Minimises ∫|ΔW|² of all faults' fields under the rules.
std::vector<std::vector<Vector2d>> smooth_directions(
    const MapMesh& map, const std::vector<std::vector<PillarRule>>& rules) {
  const std::size_t n = map.vertices.size();
  const MapOperator op = map_operator(map.vertices, map.triangles, map.triangles, n);
  const Sparse bending = op.stiffness * op.area.cwiseInverse().asDiagonal() * op.stiffness;
  std::vector<FreedomAtVertex> free;
  int n_free = 0;
  for (std::size_t v = 0; v < n; ++v) {
    free.emplace_back(rules[v]);
    free.back().first = n_free;
    n_free += free.back().n_free;
  }
  std::vector<std::vector<Vector2d>> fields(static_cast<std::size_t>(map.n_faults));
  MatrixXd right = MatrixXd::Zero(n_free, map.n_faults);
  for (int f = 0; f < map.n_faults; ++f)
    for (std::size_t v = 0; v < n; ++v) fields[f].push_back(fixed_part(rules[v], f));
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < static_cast<int>(n); ++j)
    for (Sparse::InnerIterator at(bending, j); at; ++at) {
      const FreedomAtVertex &row = free[at.row()], &column = free[j];
      for (int p = 0; p < row.n_free; ++p) {
        for (int q = 0; q < column.n_free; ++q)
          entries.emplace_back(row.first + p, column.first + q,
                               at.value() * row.basis.col(p).dot(column.basis.col(q)));
        for (int f = 0; f < map.n_faults; ++f)
          right(row.first + p, f) -= at.value() * row.basis.col(p).dot(fields[f][j]);
      }
    }
  Sparse matrix(n_free, n_free);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Sparse> factor(matrix);
  FAULTSIM_DEMAND(factor.info() == Eigen::Success, "pillars of ", n, " vertices");
  const MatrixXd found = factor.solve(right);
  for (int f = 0; f < map.n_faults; ++f)
    for (std::size_t v = 0; v < n; ++v)
      for (int p = 0; p < free[v].n_free; ++p)
        fields[f][v] += free[v].basis.col(p) * found(free[v].first + p, f);
  return fields;
}

/// Depths at which pillars are looked at: where one bends, and evenly between.
std::vector<double> depths_to_check(const LayeredBody& body) {
  std::vector<double> depths;
  constexpr int kEven = 8;
  for (int k = 0; k <= kEven; ++k) depths.push_back(body.base + (body.top - body.base) * k / kEven);
  for (const LayeredFault& fault : body.faults) {
    const FaultShift shift(fault, body.top, body.base, body.trace_depth);
    for (const DipPoint& point : shift.points()) depths.push_back(point.z);
  }
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
      : body_(body), map_(map), problems_(problems) {
    for (int f = 0; f < map.n_faults; ++f) {
      shifts_.emplace_back(body.faults[f], body.top, body.base, body.trace_depth);
      towards_.push_back(hanging_directions(body.faults[f], map, f));
    }
  }
  void stays_in_box(int f) const;
  void do_not_cut(int f, int g) const;

 private:
  std::vector<Vector2d> line_at(int f, double z) const {
    std::vector<Vector2d> line;
    for (std::size_t k = 0; k < towards_[f].size(); ++k)
      line.push_back(map_.vertices[map_.lines[f][k]] + towards_[f][k] * shifts_[f].at(z));
    return line;
  }
  double inside(const Vector2d& at) const {
    return std::min((at - body_.low).minCoeff(), (body_.high - at).minCoeff());
  }
  std::string name(int f) const { return "\"" + body_.faults[f].name + "\""; }

  const LayeredBody& body_;
  const MapMesh& map_;
  std::vector<Problem>& problems_;
  std::vector<FaultShift> shifts_;
  std::vector<std::vector<Vector2d>> towards_;
};

void DepthCheck::stays_in_box(int f) const {
  for (const DipPoint& point : shifts_[f].points()) {
    const std::vector<Vector2d> line = line_at(f, point.z);
    for (std::size_t k = 0; k < line.size(); ++k) {
      const bool is_on_edge = inside(map_.vertices[map_.lines[f][k]]) == 0;
      if (is_on_edge || inside(line[k]) > 0) continue;
      problems_.push_back({concat("/faults/", f), 0,
                           concat(name(f), " leaves the box at ", depth_place(line[k], point.z)),
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
  const double low = std::max(shifts_[f].points().front().z, shifts_[g].points().front().z);
  const double high = std::min(shifts_[f].points().back().z, shifts_[g].points().back().z);
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
         "let one end above the other: bodies that one fault truncates in depth "
         "come as a mesh of your own"});
    return;
  }
}

}  // namespace

FaultShift::FaultShift(const LayeredFault& fault, double top, double bottom, double trace_depth) {
  const double high = fault.top.value_or(top), low = fault.bottom.value_or(bottom);
  const double slope =
      fault.dip < std::numbers::pi / 2 * (1 - 1e-12) ? -1 / std::tan(fault.dip) : 0;
  std::vector<DipPoint> known = fault.listric;
  if (known.size() < 2) known = {{low, slope * low}, {high, slope * high}};
  std::ranges::sort(known, {}, &DipPoint::z);
  const auto between = [&](double z) {
    std::size_t k = 0;
    while (k + 2 < known.size() && known[k + 1].z < z) ++k;
    const double part = (z - known[k].z) / (known[k + 1].z - known[k].z);
    return (1 - part) * known[k].shift + part * known[k + 1].shift;
  };
  points_.push_back({low, between(low)});
  for (const DipPoint& point : known)
    if (point.z > low && point.z < high) points_.push_back(point);
  points_.push_back({high, between(high)});
  const double there = at(trace_depth);
  for (DipPoint& point : points_) point.shift -= there;
}

double FaultShift::at(double z) const {
  if (z <= points_.front().z) return points_.front().shift;
  if (z >= points_.back().z) return points_.back().shift;
  std::size_t k = 0;
  while (points_[k + 1].z < z) ++k;
  const double part = (z - points_[k].z) / (points_[k + 1].z - points_[k].z);
  return (1 - part) * points_[k].shift + part * points_[k + 1].shift;
}

std::vector<Vector2d> hanging_directions(const LayeredFault& fault, const MapMesh& map, int line) {
  const std::vector<int>& vertices = map.lines[line];
  std::vector<Vector2d> pieces, directions;
  const double sign = fault.dips_to == DipSide::right ? 1 : -1;
  for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
    const Vector2d t = (map.vertices[vertices[k + 1]] - map.vertices[vertices[k]]).normalized();
    pieces.emplace_back(sign * t.y(), -sign * t.x());
  }
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vector2d& before = pieces[k > 0 ? k - 1 : 0];
    const Vector2d& after = pieces[std::min(k, pieces.size() - 1)];
    const Vector2d mean = (before + after) / 2;
    directions.emplace_back(mean / mean.squaredNorm());
  }
  return directions;
}

Pillars::Pillars(const LayeredBody& body, const MapMesh& map) : vertices_(map.vertices) {
  for (const LayeredFault& fault : body.faults)
    shifts_.emplace_back(fault, body.top, body.base, body.trace_depth);
  w_ = smooth_directions(map, pillar_rules(body, map));
}

Vector2d Pillars::in_map(int vertex, double z) const {
  Vector2d at = vertices_[vertex];
  for (std::size_t f = 0; f < shifts_.size(); ++f) at += w_[f][vertex] * shifts_[f].at(z);
  return at;
}

std::vector<double> Pillars::shifts_at(double z) const {
  std::vector<double> shifts;
  for (const FaultShift& shift : shifts_) shifts.push_back(shift.at(z));
  return shifts;
}

Vector2d Pillars::in_map(int vertex, const std::vector<double>& shifts) const {
  Vector2d at = vertices_[vertex];
  for (std::size_t f = 0; f < shifts.size(); ++f) at += w_[f][vertex] * shifts[f];
  return at;
}

Vector3d Pillars::at(int vertex, double z) const {
  const Vector2d place = in_map(vertex, z);
  return {place.x(), place.y(), z};
}

void check_faults_in_depth(const LayeredBody& body, const MapMesh& map,
                           std::vector<Problem>& problems) {
  const DepthCheck check(body, map, problems);
  for (int f = 0; f < map.n_faults; ++f) {
    check.stays_in_box(f);
    for (int g = 0; g < f; ++g) check.do_not_cut(f, g);
  }
}

void check_pillars(const LayeredBody& body, const MapMesh& map, const Pillars& pillars,
                   std::vector<Problem>& problems) {
  constexpr double kLeast = 0.1;
  double worst = kLeast, worst_z = 0;
  std::size_t count = 0;
  Vector2d place = Vector2d::Zero();
  std::vector<Vector2d> moved(map.vertices.size());
  for (const double z : depths_to_check(body)) {
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
