#include "simulator/horizons/map_locator.h"

#include <algorithm>
#include <cmath>

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A triangle of the map at a depth, with the shares of its corners in a place.
struct MovedTriangle {
  std::array<Vector2d, 3> corner;
  std::array<double, 3> share;

  MovedTriangle(const std::array<int, 3>& triangle, const Pillars& pillars,
                const PillarDepth& depth, const Vector2d& place) {
    for (std::size_t v = 0; v < 3; ++v) corner[v] = pillars.in_map(triangle[v], depth);
    const double all = cross_of(corner[0], corner[1], corner[2]);
    for (std::size_t v = 0; v < 3; ++v)
      share[v] = cross_of(place, corner[(v + 1) % 3], corner[(v + 2) % 3]) / all;
  }
  std::size_t least() const {
    return static_cast<std::size_t>(std::ranges::min_element(share) - share.begin());
  }
};

}  // namespace

MapLocator::MapLocator(const LayeredBody& body, const MapMesh& map,
                       const std::vector<MapSide>& sides, const Pillars& pillars)
    : low_(body.low), high_(body.high), map_(map), pillars_(pillars) {
  across_.resize(map.triangles.size(), {-1, -1, -1});
  for (const MapSide& side : sides)
    for (const int t : {side.left, side.right}) {
      if (t < 0) continue;
      for (std::size_t v = 0; v < 3; ++v)
        if (const int vertex = map.triangles[t][v]; vertex != side.a && vertex != side.b)
          across_[t][v] = t == side.left ? side.right : side.left;
    }
  n_bins_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(map.triangles.size()))));
  start_.resize(static_cast<std::size_t>(n_bins_) * static_cast<std::size_t>(n_bins_), 0);
  const auto bin = [&](double x, int axis) {
    const double part = (x - low_[axis]) / (high_[axis] - low_[axis]);
    return std::clamp(static_cast<int>(part * n_bins_), 0, n_bins_ - 1);
  };
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    Vector2d from = map.vertices[map.triangles[t][0]], to = from;
    for (const int v : map.triangles[t]) {
      from = from.cwiseMin(map.vertices[v]);
      to = to.cwiseMax(map.vertices[v]);
    }
    for (int j = bin(from.y(), 1); j <= bin(to.y(), 1); ++j)
      for (int i = bin(from.x(), 0); i <= bin(to.x(), 0); ++i)
        start_[j * n_bins_ + i] = static_cast<int>(t);
  }
}

int MapLocator::start_at(const Vector2d& at) const {
  const Vector2d part = (at - low_).cwiseQuotient(high_ - low_) * n_bins_;
  const int i = std::clamp(static_cast<int>(part.x()), 0, n_bins_ - 1);
  const int j = std::clamp(static_cast<int>(part.y()), 0, n_bins_ - 1);
  return start_[j * n_bins_ + i];
}

PlaceOnMap MapLocator::find(const Vector3d& point) const {
  const Vector2d there = point.head<2>();
  const Vector2d inside = there.cwiseMax(low_).cwiseMin(high_);
  const PillarDepth depth = pillars_.depth(point.z());
  const auto place = [&](int triangle) -> PlaceOnMap {
    const MovedTriangle moved(map_.triangles[triangle], pillars_, depth, inside);
    Vector2d at = there - inside;
    for (std::size_t v = 0; v < 3; ++v)
      at += moved.share[v] * map_.vertices[map_.triangles[triangle][v]];
    return {triangle, at};
  };
  // From triangle to triangle, over the side that the point lies furthest beyond.
  int triangle = start_at(inside);
  for (std::size_t step = 0; step < map_.triangles.size(); ++step) {
    const MovedTriangle moved(map_.triangles[triangle], pillars_, depth, inside);
    const std::size_t least = moved.least();
    const int next = across_[triangle][least];
    if (moved.share[least] >= 0 || next < 0) return place(triangle);
    triangle = next;
  }
  // The way can go in circles; then all are looked at.
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < map_.triangles.size(); ++t) {
    const MovedTriangle moved(map_.triangles[t], pillars_, depth, inside);
    if (moved.share[moved.least()] <= best) continue;
    best = moved.share[moved.least()];
    triangle = static_cast<int>(t);
  }
  return place(triangle);
}

}  // namespace faultsim::horizons
