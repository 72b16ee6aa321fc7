#include "simulator/model/strike_coordinate.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "simulator/common/disjoint_sets.h"

namespace faultsim {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<int, 3>;
using Edge = std::pair<int, int>;

constexpr double kNoArea = 1e-12;     // of the square of an edge
constexpr double kHorizontal = 1e-9;  // horizontal part of a normal

std::array<Edge, 3> edges_of(const Triangle& t) {
  return {Edge(t[0], t[1]), Edge(t[1], t[2]), Edge(t[2], t[0])};
}
Edge sorted(const Edge& edge) { return std::minmax(edge.first, edge.second); }

/// See strike_coordinate().
class StrikePotential {
 public:
  StrikePotential(std::span<const Vector3d> points, std::span<const std::array<int, 4>> faces)
      : points_(points), part_(connected_parts(points.size(), faces)) {
    for (const auto& face : faces) {
      add_triangle({face[0], face[1], face[2]});
      add_triangle({face[0], face[2], face[3]});
    }
    if (!part_.empty()) n_parts_ = 1 + *std::ranges::max_element(part_);
  }

  StrikeCoordinate solve() {
    orient();
    point_northward();
    StrikeCoordinate result{.along = minimiser(), .part = part_, .mean = Vector3d::Zero()};
    for (const Vector3d& strike : strike_of_part_) result.mean += strike;
    result.mean = direction_of(result.mean);
    move_to_means(result.along);
    return result;
  }

 private:
  void add_triangle(const Triangle& corners) {
    const Vector3d a = points_[corners[1]] - points_[corners[0]],
                   b = points_[corners[2]] - points_[corners[0]];
    if (a.cross(b).norm() > kNoArea * std::max(a.squaredNorm(), b.squaredNorm()))
      triangles_.push_back(corners);
  }

  Vector3d area(const Triangle& t) const {
    return 0.5 * (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
  }

  /// The strike times the area; zero where a triangle is horizontal.
  Vector3d strike(const Triangle& t) const {
    const Vector3d normal = area(t), across = normal.cross(Vector3d::UnitZ());
    if (across.norm() <= kHorizontal * normal.norm()) return Vector3d::Zero();
    return normal.norm() * across.normalized();
  }

  /// Triangles that share an edge look to the same side afterwards.
  void orient() {
    std::map<Edge, std::vector<std::size_t>> beside;
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
      for (const Edge& edge : edges_of(triangles_[k])) beside[sorted(edge)].push_back(k);
    }
    std::vector<bool> is_seen(triangles_.size());
    for (std::size_t seed = 0; seed < triangles_.size(); ++seed) {
      if (is_seen[seed]) continue;
      is_seen[seed] = true;
      for (std::vector<std::size_t> waiting{seed}; !waiting.empty();) {
        const Triangle at = triangles_[waiting.back()];
        waiting.pop_back();
        for (const Edge& edge : edges_of(at)) {
          for (const std::size_t k : beside[sorted(edge)]) {
            if (is_seen[k]) continue;
            // Neighbours that look to the same side walk along their edge in opposite directions.
            if (std::ranges::count(edges_of(triangles_[k]), edge) > 0)
              std::swap(triangles_[k][1], triangles_[k][2]);
            is_seen[k] = true;
            waiting.push_back(k);
          }
        }
      }
    }
  }

  /// Turns parts whose strike points southward.
  void point_northward() {
    strike_of_part_.assign(n_parts_, Vector3d::Zero());
    for (const Triangle& t : triangles_) strike_of_part_[part_[t[0]]] += strike(t);
    for (Triangle& t : triangles_) {
      if (!is_northward(strike_of_part_[part_[t[0]]])) std::swap(t[1], t[2]);
    }
    for (Vector3d& strike : strike_of_part_) {
      if (!is_northward(strike)) strike = -strike;
    }
  }

  static Vector3d direction_of(const Vector3d& strike) {
    return strike.norm() > 0 ? strike.normalized() : Vector3d::UnitY();
  }

  /// K s = b of the elements, with one point of each part held at 0, and those without area.
  std::vector<double> minimiser() const {
    const auto n = static_cast<Eigen::Index>(points_.size());
    std::vector<int> held(n_parts_, -1);
    std::vector<bool> is_free(points_.size());
    for (const Triangle& t : triangles_) {
      if (held[part_[t[0]]] < 0) held[part_[t[0]]] = t[0];
      for (const int corner : t) is_free[corner] = corner != held[part_[corner]];
    }
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (const Triangle& t : triangles_) add_element(t, is_free, entries, b);
    for (int i = 0; i < static_cast<int>(n); ++i) {
      if (!is_free[i]) entries.emplace_back(i, i, 1.0);
    }
    Eigen::SparseMatrix<double> k(n, n);
    k.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd s = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(k).solve(b);
    return {s.begin(), s.end()};
  }

  void add_element(const Triangle& t, const std::vector<bool>& is_free,
                   std::vector<Eigen::Triplet<double>>& entries, Eigen::VectorXd& b) const {
    const Vector3d normal = area(t);
    const double size = normal.norm();
    Vector3d along = strike(t) / size;
    if (along.isZero()) along = direction_of(strike_of_part_[part_[t[0]]]);
    std::array<Vector3d, 3> gradient;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d opposite = points_[t[(i + 2) % 3]] - points_[t[(i + 1) % 3]];
      gradient[i] = normal.normalized().cross(opposite) / (2 * size);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_free[t[i]]) continue;
      b[t[i]] += size * gradient[i].dot(along);
      for (std::size_t j = 0; j < 3; ++j) {
        if (is_free[t[j]]) entries.emplace_back(t[i], t[j], size * gradient[i].dot(gradient[j]));
      }
    }
  }

  /// Adds to each part what makes its mean over the area that of the projected positions.
  void move_to_means(std::vector<double>& along) const {
    std::vector<double> sum(n_parts_, 0), total(n_parts_, 0);
    for (const Triangle& t : triangles_) {
      const int part = part_[t[0]];
      const Vector3d strike = direction_of(strike_of_part_[part]);
      const double size = area(t).norm();
      for (const int corner : t) sum[part] += size * (points_[corner].dot(strike) - along[corner]);
      total[part] += 3 * size;
    }
    for (std::size_t i = 0; i < along.size(); ++i) {
      if (total[part_[i]] > 0) along[i] += sum[part_[i]] / total[part_[i]];
    }
  }

  std::span<const Vector3d> points_;
  std::vector<int> part_;
  std::vector<Triangle> triangles_;
  int n_parts_ = 0;
  std::vector<Vector3d> strike_of_part_;  // times its area
};

}  // namespace

std::vector<int> connected_parts(std::size_t n_points, std::span<const std::array<int, 4>> faces) {
  DisjointSets sets(n_points);
  for (const auto& face : faces) {
    for (const int corner : face) sets.join(face[0], corner);
  }
  return sets.numbered();
}

bool is_northward(const Vector3d& strike) {
  return strike[std::abs(strike.x()) > std::abs(strike.y()) ? 0 : 1] >= 0;
}

StrikeCoordinate strike_coordinate(std::span<const Vector3d> points,
                                   std::span<const std::array<int, 4>> faces) {
  return StrikePotential(points, faces).solve();
}

}  // namespace faultsim
