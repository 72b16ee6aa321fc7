#include "simulator/horizons/depth_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

template <typename... Cases>
struct DepthCases : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
DepthCases(Cases...) -> DepthCases<Cases...>;

double on_grid(const GridDepth& grid, const Vector2d& place) {
  const auto along = [&](int axis, int n) {
    const double at = (place[axis] - grid.origin[axis]) / grid.spacing[axis];
    return std::clamp(at, 0.0, n - 1.0);
  };
  const double u = along(0, grid.nx), v = along(1, grid.ny);
  const int i = std::min(static_cast<int>(u), std::max(grid.nx - 2, 0));
  const int j = std::min(static_cast<int>(v), std::max(grid.ny - 2, 0));
  const auto z = [&](int a, int b) {
    const int column = std::min(a, grid.nx - 1), row = std::min(b, grid.ny - 1);
    return grid.z[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.nx) +
                  static_cast<std::size_t>(column)];
  };
  const double p = u - i, q = v - j;
  return (1 - q) * ((1 - p) * z(i, j) + p * z(i + 1, j)) +
         q * ((1 - p) * z(i, j + 1) + p * z(i + 1, j + 1));
}

void check_depth(const GridDepth& grid, const std::string& pointer,
                 std::vector<Problem>& problems) {
  const bool has_shape = grid.nx >= 1 && grid.ny >= 1 && grid.spacing.minCoeff() > 0;
  if (!has_shape) {
    problems.push_back({pointer, 0, "a grid of depths has no points or no spacing",
                        "give one point or more along x and y, and spacings above 0 m"});
    return;
  }
  const auto n = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
  if (grid.z.size() != n)
    problems.push_back({pointer, 0,
                        concat("a grid of ", grid.nx, " by ", grid.ny, " points has ",
                               counted(grid.z.size(), "depth", "depths")),
                        concat("give ", n)});
  for (std::size_t k = 0; k < grid.z.size() && k < n; ++k) {
    if (std::isfinite(grid.z[k])) continue;
    const auto row = static_cast<int>(k / static_cast<std::size_t>(grid.nx));
    const auto column = static_cast<int>(k % static_cast<std::size_t>(grid.nx));
    problems.push_back(
        {pointer, 0,
         concat("the depth at x ", grid.origin.x() + column * grid.spacing.x(), ", y ",
                grid.origin.y() + row * grid.spacing.y(), " m is not a number"),
         "fill the gaps of the grid"});
    return;
  }
}

void check_depth(const PointDepth& scattered, const std::string& pointer,
                 std::vector<Problem>& problems) {
  if (scattered.points.empty()) {
    problems.push_back({pointer, 0, "a horizon has no points", "give one or more"});
    return;
  }
  std::map<std::pair<double, double>, double> known;
  for (const Vector3d& p : scattered.points) {
    if (!p.allFinite()) {
      problems.push_back({pointer, 0, "a point of a horizon is not a number", "leave it out"});
      return;
    }
    const auto [at, is_new] = known.emplace(std::pair(p.x(), p.y()), p.z());
    if (is_new || at->second == p.z()) continue;
    problems.push_back({pointer, 0,
                        concat("at x ", p.x(), ", y ", p.y(), " m a horizon has the depths ",
                               at->second, " and ", p.z(), " m"),
                        "keep one of them; a step is the throw of a fault"});
    return;
  }
}

/// Where on the way from a to b the nearest point to place is, [0, 1].
double nearest_part(const Vector2d& a, const Vector2d& b, const Vector2d& place) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((place - a).dot(b - a) / length2, 0.0, 1.0) : 0;
}

}  // namespace

double PointSupport::of(const std::vector<double>& values) const {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (corner[k] >= 0) sum += weight[k] * values[static_cast<std::size_t>(corner[k])];
  return sum;
}

PointSurface::PointSurface(std::vector<Vector3d> points) {
  const auto by_place = [](const Vector3d& p, const Vector3d& q) {
    return std::pair(p.x(), p.y()) < std::pair(q.x(), q.y());
  };
  std::vector<Vector3d> given = std::move(points);
  given_.resize(given.size());
  std::iota(given_.begin(), given_.end(), std::size_t{0});
  std::ranges::stable_sort(given_, by_place, [&](std::size_t k) { return given[k]; });
  for (const std::size_t k : given_) points_.push_back(given[k]);
  std::vector<Vector2d> places;
  for (const Vector3d& p : points_) {
    places.push_back(p.head<2>());
    depths_.push_back(p.z());
  }
  triangles_ = delaunay(places);
  std::map<std::pair<int, int>, int> count;
  for (const std::array<int, 3>& t : triangles_)
    for (std::size_t v = 0; v < 3; ++v) ++count[std::minmax(t[v], t[(v + 1) % 3])];
  for (const auto& [side, n] : count)
    if (n == 1) edge_.push_back({side.first, side.second});
  if (triangles_.empty())
    for (int k = 0; k + 1 < static_cast<int>(points_.size()); ++k) edge_.push_back({k, k + 1});
  if (edge_.empty()) edge_.push_back({0, 0});
  sort_into_bins();
}

std::vector<double> PointSurface::in_order(const std::vector<double>& given) const {
  return mapped(given_, [&](std::size_t k) { return given[k]; });
}

void PointSurface::sort_into_bins() {
  low_ = points_.front().head<2>();
  Vector2d high = low_;
  for (const Vector3d& p : points_) {
    low_ = low_.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  n_bins_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(triangles_.size()))));
  bin_size_ = ((high - low_) / n_bins_).cwiseMax(1e-30);
  bins_.resize(static_cast<std::size_t>(n_bins_) * static_cast<std::size_t>(n_bins_));
  const auto bin = [&](double x, int axis) {
    return std::clamp(static_cast<int>((x - low_[axis]) / bin_size_[axis]), 0, n_bins_ - 1);
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    Vector2d from = points_[triangles_[t][0]].head<2>(), to = from;
    for (const int v : triangles_[t]) {
      from = from.cwiseMin(points_[v].head<2>());
      to = to.cwiseMax(points_[v].head<2>());
    }
    for (int j = bin(from.y(), 1); j <= bin(to.y(), 1); ++j)
      for (int i = bin(from.x(), 0); i <= bin(to.x(), 0); ++i)
        bins_[j * n_bins_ + i].push_back(static_cast<int>(t));
  }
}

PointSupport PointSurface::on_edge(const Vector2d& place) const {
  double nearest = std::numeric_limits<double>::infinity();
  PointSupport support{{0, -1, -1}, {1, 0, 0}};
  for (const auto& [a, b] : edge_) {
    const Vector2d p = points_[a].head<2>(), q = points_[b].head<2>();
    const double part = nearest_part(p, q, place);
    const double away = (p + part * (q - p) - place).squaredNorm();
    if (away >= nearest) continue;
    nearest = away;
    support = {{a, b, -1}, {1 - part, part, 0}, std::sqrt(away)};
  }
  return support;
}

PointSupport PointSurface::support_at(const Vector2d& place) const {
  const Vector2d bin = (place - low_).cwiseQuotient(bin_size_);
  if (bin.minCoeff() < 0 || bin.maxCoeff() > n_bins_) return on_edge(place);
  const int i = std::min(static_cast<int>(bin.x()), n_bins_ - 1);
  const int j = std::min(static_cast<int>(bin.y()), n_bins_ - 1);
  for (const int t : bins_[j * n_bins_ + i]) {
    const auto corner = [&](std::size_t v) -> Vector2d {
      return points_[triangles_[t][v]].head<2>();
    };
    const double all = cross_of(corner(0), corner(1), corner(2));
    const double a = cross_of(place, corner(1), corner(2)) / all;
    const double b = cross_of(corner(0), place, corner(2)) / all;
    constexpr double kOnSide = -1e-9;
    if (std::min({a, b, 1 - a - b}) < kOnSide) continue;
    return {triangles_[t], {a, b, 1 - a - b}};
  }
  return on_edge(place);
}

double PointSurface::at(const Vector2d& place) const { return support_at(place).of(depths_); }

DepthSurface::DepthSurface(const DepthOverMap& depth, const std::string& pointer,
                           std::vector<Problem>& problems, const DepthSurface* above)
    : depth_(depth) {
  const std::size_t before = problems.size();
  const auto demand_number = [&](bool is_number) {
    if (!is_number)
      problems.push_back(
          {pointer, 0, "a depth is not a number", "give metres, negative below z = 0"});
  };
  std::visit(DepthCases{[&](const ConstantDepth& one) { demand_number(std::isfinite(one.z)); },
                        [&](const PlaneDepth& plane) {
                          demand_number(std::isfinite(plane.z) && plane.at.allFinite() &&
                                        plane.slope.allFinite());
                        },
                        [&](const HungDepth& hung) { hang(hung, above, pointer, problems); },
                        [&](const auto& data) { check_depth(data, pointer, problems); }},
             depth);
  if (problems.size() > before) return;
  if (const auto* scattered = std::get_if<PointDepth>(&depth_))
    scattered_ = std::make_shared<PointSurface>(scattered->points);
}

void DepthSurface::hang(const HungDepth& hung, const DepthSurface* above,
                        const std::string& pointer, std::vector<Problem>& problems) {
  const auto refuse = [&](const std::string& what, const std::string& cure) {
    problems.push_back({pointer, 0, what, cure});
  };
  if (above == nullptr || above->scattered() == nullptr)
    return refuse("thicknesses are given at points, but the horizon above has none",
                  "give the horizon above by points, or this one by depths");
  const std::size_t n = above->scattered()->points().size();
  if (hung.thickness.size() != n)
    return refuse(concat(hung.thickness.size(), " thicknesses for ", counted(n, "point", "points"),
                         " of the horizon above"),
                  "give one for each");
  if (!std::ranges::all_of(hung.thickness, [](double t) { return t > 0 && std::isfinite(t); }))
    return refuse("a thickness is not above 0", "give metres, above 0");
  scattered_ = above->scattered_;
  thickness_ = scattered_->in_order(hung.thickness);
  below_points_ = above->below_points_;
  below_points_.resize(n, 0);
  for (std::size_t k = 0; k < n; ++k) below_points_[k] += thickness_[k];
}

double DepthSurface::at(const Vector2d& place) const {
  return std::visit(
      DepthCases{
          [](const ConstantDepth& one) { return one.z; },
          [&](const PlaneDepth& plane) { return plane.z + plane.slope.dot(place - plane.at); },
          [&](const GridDepth& grid) { return on_grid(grid, place); },
          [&](const PointDepth&) { return scattered_->at(place); },
          [&](const HungDepth&) {
            const PointSupport support = scattered_->support_at(place);
            return support.of(scattered_->depths()) - support.of(below_points_);
          }},
      depth_);
}

std::vector<DepthSurface> depth_surfaces(const LayeredBody& body, std::vector<Problem>& problems) {
  std::vector<DepthSurface> all;
  all.reserve(body.horizons.size());
  for (std::size_t k = 0; k < body.horizons.size(); ++k)
    all.emplace_back(body.horizons[k].depth, concat("/horizons/", k, "/depth"), problems,
                     k == 0 ? nullptr : &all[k - 1]);
  return all;
}

}  // namespace faultsim::horizons
