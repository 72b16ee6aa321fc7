#include "simulator/flow/nearest_areas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>

namespace faultsim {
namespace {

using Place2 = Eigen::Vector2d;

double cross(const Place2& a, const Place2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Places in squares of a side at which there is about one in each.
class PlaceBins {
 public:
  explicit PlaceBins(const std::vector<Place2>& places) : places_(places) {
    for (const Place2& place : places) extent_.extend(place);
    const double area = extent_.sizes().prod(), length = extent_.sizes().sum();
    const auto n = static_cast<double>(places.size());
    side_ = std::max(std::sqrt(area / n), length / n);
    for (std::size_t i = 0; i < places.size(); ++i) bins_[key_of(places[i])].push_back(i);
  }
  double side() const { return side_; }
  double length() const { return extent_.sizes().sum(); }

  /// Numbers of the places within a distance, the nearest first, equals by their number; without
  /// the place itself.
  std::vector<std::size_t> within(std::size_t own, double distance) const {
    const Place2& middle = places_[own];
    const Place2 reach(distance, distance);
    const auto [i0, j0] = index_of(middle - reach);
    const auto [i1, j1] = index_of(middle + reach);
    std::vector<std::pair<double, std::size_t>> found;
    for (long i = i0; i <= i1; ++i) {
      for (long j = j0; j <= j1; ++j) {
        const auto bin = bins_.find(key(i, j));
        if (bin == bins_.end()) continue;
        for (const std::size_t other : bin->second) {
          const double apart = (places_[other] - middle).norm();
          if (other != own && apart <= distance) found.emplace_back(apart, other);
        }
      }
    }
    std::ranges::sort(found);
    std::vector<std::size_t> numbers;
    for (const auto& one : found) numbers.push_back(one.second);
    return numbers;
  }

 private:
  std::pair<long, long> index_of(const Place2& at) const {
    const auto steps = [&](int axis) {
      return std::lround(std::floor((at[axis] - extent_.min()[axis]) / side_));
    };
    return {steps(0), steps(1)};
  }
  static long key(long i, long j) { return i * 2'000'000'011L + j; }
  long key_of(const Place2& at) const {
    const auto [i, j] = index_of(at);
    return key(i, j);
  }

  const std::vector<Place2>& places_;
  Eigen::AlignedBox2d extent_;
  double side_ = 1;
  std::unordered_map<long, std::vector<std::size_t>> bins_;
};

/// The convex hull, counter-clockwise, without places on its edges (Andrew's monotone chain).
ConvexPolygon hull_of(std::vector<Place2> places) {
  std::sort(places.begin(), places.end(), [](const Place2& a, const Place2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  ConvexPolygon hull;
  const auto add = [&](const Place2& place, std::size_t kept) {
    while (hull.size() >= kept + 2 &&
           cross(hull.back() - hull[hull.size() - 2], place - hull.back()) <= 0)
      hull.pop_back();
    hull.push_back(place);
  };
  for (const Place2& place : places) add(place, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto place = places.rbegin() + 1; place != places.rend(); ++place) add(*place, lower);
  hull.pop_back();
  return hull;
}

/// Cuts off what lies beyond a line. @param outwards  of length 1. @param from  where on it the
/// line is.
void cut(ConvexPolygon& polygon, const Place2& outwards, double from) {
  ConvexPolygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Place2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double beyond_a = outwards.dot(a) - from, beyond_b = outwards.dot(b) - from;
    if (beyond_a <= 0) left.push_back(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
      left.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
  }
  polygon = std::move(left);
}

/// Corners that rounding doubled become one.
void join_corners(ConvexPolygon& polygon, double near) {
  ConvexPolygon kept;
  for (const Place2& corner : polygon) {
    if (kept.empty() || (corner - kept.back()).norm() > near) kept.push_back(corner);
  }
  while (kept.size() > 1 && (kept.front() - kept.back()).norm() <= near) kept.pop_back();
  polygon = std::move(kept);
}

/// All of a disc, as the polygon around it.
ConvexPolygon around_disc(double radius) {
  constexpr int kCorners = 16;
  constexpr double kStep = 2 * std::numbers::pi / kCorners;
  ConvexPolygon polygon;
  for (int i = 0; i < kCorners; ++i)
    polygon.push_back(radius / std::cos(kStep / 2) *
                      Place2(std::cos(i * kStep), std::sin(i * kStep)));
  return polygon;
}

double reach_of(const ConvexPolygon& polygon) {
  double reach = 0;
  for (const Place2& corner : polygon) reach = std::max(reach, corner.norm());
  return reach;
}

class AreaMaker {
 public:
  explicit AreaMaker(const std::vector<Place2>& places) : places_(places), bins_(places) {}

  NearestAreas make() {
    NearestAreas areas;
    hull_ = hull_of(places_);
    constexpr double kOneLine = 1e-9;  // of the length squared
    if (hull_.size() < 3 || polygon_area(hull_) < kOneLine * std::pow(bins_.length(), 2))
      return areas;
    std::vector<double> nearest;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const std::vector<double> apart = distances(i);
      nearest.push_back(apart.front());
      radius_.push_back(apart.back());
    }
    const auto middle = nearest.begin() + std::ssize(nearest) / 2;
    std::nth_element(nearest.begin(), middle, nearest.end());
    areas.rim = 0.5 * *middle;
    for (std::size_t i = 0; i < places_.size(); ++i) areas.area.push_back(area(i, areas.rim));
    return areas;
  }

 private:
  static constexpr std::size_t kNeighbours = 8;

  /// To the nearest neighbours, ascending.
  std::vector<double> distances(std::size_t own) const {
    double reach = bins_.side();
    std::vector<std::size_t> near = bins_.within(own, reach);
    while (near.size() < kNeighbours && reach < bins_.length())
      near = bins_.within(own, reach *= 1.5);
    near.resize(std::min(near.size(), kNeighbours));
    std::vector<double> apart;
    for (const std::size_t other : near) apart.push_back((places_[other] - places_[own]).norm());
    return apart;
  }

  /// Seen from the place itself, so that coordinates of maps cost no digits.
  ConvexPolygon area(std::size_t own, double rim) const {
    const Place2& middle = places_[own];
    ConvexPolygon polygon = around_disc(radius_[own]);
    for (const std::size_t other : bins_.within(own, 2 * reach_of(polygon))) {
      const Place2 apart = places_[other] - middle;
      if (0.5 * apart.norm() > reach_of(polygon)) break;
      cut(polygon, apart.normalized(), 0.5 * apart.norm());
    }
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      const Place2 along = (hull_[(i + 1) % hull_.size()] - hull_[i]).normalized();
      const Place2 outwards(along.y(), -along.x());
      const double from = outwards.dot(hull_[i] - middle) + rim;
      if (from < reach_of(polygon)) cut(polygon, outwards, from);
    }
    constexpr double kSame = 1e-6;
    join_corners(polygon, kSame * radius_[own]);
    for (Place2& corner : polygon) corner += middle;
    return polygon;
  }

  const std::vector<Place2>& places_;
  PlaceBins bins_;
  ConvexPolygon hull_;
  std::vector<double> radius_;  ///< per place: no farther.
};

}  // namespace

double polygon_area(const ConvexPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return 0.5 * twice;
}

NearestAreas nearest_areas(const std::vector<Eigen::Vector2d>& places) {
  if (places.size() < 3) return {};
  return AreaMaker(places).make();
}

}  // namespace faultsim
