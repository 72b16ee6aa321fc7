#include "simulator/horizons/delaunay.h"

#include <algorithm>
#include <boost/polygon/voronoi.hpp>
#include <cmath>
#include <cstdint>

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using WholePoint = boost::polygon::point_data<int>;

/// Whole coordinates, so that the triangulation is decided exactly.
std::vector<WholePoint> whole_points(const std::vector<Vector2d>& points) {
  constexpr double kMost = 1 << 29;
  Vector2d low = points.front(), high = points.front();
  for (const Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).maxCoeff();
  const double scale = extent > 0 ? kMost / extent : 1;
  std::vector<WholePoint> whole;
  whole.reserve(points.size());
  for (const Vector2d& p : points) {
    const Vector2d at = (p - low) * scale;
    whole.emplace_back(static_cast<int>(std::lround(at.x())),
                       static_cast<int>(std::lround(at.y())));
  }
  return whole;
}

std::int64_t whole_cross(const WholePoint& a, const WholePoint& b, const WholePoint& c) {
  const auto less = [](int p, int q) { return static_cast<std::int64_t>(p) - q; };
  return less(b.x(), a.x()) * less(c.y(), a.y()) - less(b.y(), a.y()) * less(c.x(), a.x());
}

}  // namespace

Triangles delaunay(const std::vector<Vector2d>& points) {
  Triangles triangles;
  if (points.size() < 3) return triangles;
  const std::vector<WholePoint> whole = whole_points(points);
  boost::polygon::voronoi_diagram<double> diagram;
  boost::polygon::construct_voronoi(whole.begin(), whole.end(), &diagram);
  std::vector<int> around;
  for (const auto& vertex : diagram.vertices()) {
    // The cells around a vertex are the points on an empty circle: a fan of triangles.
    around.clear();
    const auto* edge = vertex.incident_edge();
    do {
      around.push_back(static_cast<int>(edge->cell()->source_index()));
      edge = edge->rot_next();
    } while (edge != vertex.incident_edge());
    std::rotate(around.begin(), std::ranges::min_element(around), around.end());
    for (std::size_t k = 2; k < around.size(); ++k) {
      std::array<int, 3> triangle = {around[0], around[k - 1], around[k]};
      const std::int64_t area =
          whole_cross(whole[triangle[0]], whole[triangle[1]], whole[triangle[2]]);
      if (area < 0) std::swap(triangle[1], triangle[2]);
      if (area != 0) triangles.push_back(triangle);
    }
  }
  return triangles;
}

}  // namespace faultsim::horizons
