#include "simulator/horizons/sided_points.h"

#include <algorithm>
#include <cmath>

namespace faultsim::horizons {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostSeen = 14;
constexpr std::size_t kMostLookedAt = 400;
constexpr double kThin = 0.4;  // of the way to a point, to those taken before

}  // namespace

SidedPoints::SidedPoints(const PointSurface& surface, const std::vector<Vector2d>& on_map)
    : surface_(surface), on_map_(on_map), is_out_(on_map.size(), false), low_(on_map.front()) {
  Vector2d high = low_;
  for (const Vector2d& at : on_map) {
    low_ = low_.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  // Bins of about three points.
  const Vector2d size = high - low_;
  extent_ = std::max(size.norm(), 1.0);
  const double area = std::max(size.x() * size.y(), 1e-6 * extent_ * extent_);
  bin_size_ = std::sqrt(3 * area / static_cast<double>(on_map.size()));
  nx_ = static_cast<int>(size.x() / bin_size_) + 1;
  ny_ = static_cast<int>(size.y() / bin_size_) + 1;
  bins_.resize(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_));
  for (std::size_t k = 0; k < on_map.size(); ++k) {
    const Vector2d part = (on_map[k] - low_) / bin_size_;
    const int i = std::min(static_cast<int>(part.x()), nx_ - 1);
    const int j = std::min(static_cast<int>(part.y()), ny_ - 1);
    bins_[j * nx_ + i].push_back(static_cast<int>(k));
  }
}

void SidedPoints::leave_out(const MapBarriers& barriers, double away) {
  for (std::size_t k = 0; k < on_map_.size(); ++k)
    is_out_[k] = barriers.is_within(on_map_[k], away);
}

std::vector<SidedPoints::Candidate> SidedPoints::nearest(const Vector2d& from,
                                                         double within) const {
  const auto bin = [&](double x, double low, int n) {
    return static_cast<int>(std::clamp(std::floor((x - low) / bin_size_), 0.0, n - 1.0));
  };
  std::vector<Candidate> found;
  for (int j = bin(from.y() - within, low_.y(), ny_); j <= bin(from.y() + within, low_.y(), ny_);
       ++j)
    for (int i = bin(from.x() - within, low_.x(), nx_); i <= bin(from.x() + within, low_.x(), nx_);
         ++i)
      for (const int k : bins_[j * nx_ + i]) {
        const double away = (on_map_[k] - from).norm();
        if (away <= within && !is_out_[k]) found.push_back({away, k});
      }
  const auto most = found.begin() + std::min(std::ssize(found), std::ptrdiff_t{kMostLookedAt});
  std::ranges::partial_sort(found, most, [](const Candidate& p, const Candidate& q) {
    return std::pair(p.away, p.point) < std::pair(q.away, q.point);
  });
  return found;
}

bool SidedPoints::is_seen(const MapBarriers& barriers, const Vector2d& from,
                          const Vector2d& xy) const {
  const PointSupport support = surface_.support_at(xy);
  for (const int corner : support.corner)
    if (corner >= 0 && (is_out_[corner] || !barriers.sees(from, on_map_[corner]))) return false;
  return support.away == 0 || !barriers.is_within(from, support.away);
}

std::vector<SidedPoints::Candidate> SidedPoints::seen(const MapBarriers& barriers,
                                                      const Vector2d& from) const {
  const auto all = static_cast<double>(extent_ + (from - low_).norm());
  std::vector<Candidate> seen;
  std::size_t n_looked_at = 0;
  for (double within = 3 * bin_size_;; within *= 2) {
    const std::vector<Candidate> near = nearest(from, within);
    for (; n_looked_at < std::min(near.size(), kMostLookedAt); ++n_looked_at) {
      const double away = near[n_looked_at].away;
      const int k = near[n_looked_at].point;
      const auto at = [&](int point) { return surface_.points()[point].head<2>(); };
      const bool is_by_another = std::ranges::any_of(seen, [&](const Candidate& other) {
        return (at(other.point) - at(k)).norm() < kThin * away;
      });
      if (is_by_another || !barriers.sees(from, on_map_[k])) continue;
      seen.push_back(near[n_looked_at]);
      if (seen.size() == kMostSeen) return seen;
    }
    if (n_looked_at == kMostLookedAt || within > all) break;
  }
  return seen;
}

std::optional<LocalFit> SidedPoints::fit(const MapBarriers& barriers, const Vector2d& from) const {
  std::vector<SeenPoint> points;
  for (const Candidate& one : seen(barriers, from))
    points.push_back({surface_.points()[one.point], one.away});
  if (points.empty()) return std::nullopt;
  return LocalFit(points, bin_size_);
}

std::optional<double> SidedPoints::fitted(const std::vector<double>& values,
                                          const MapBarriers& barriers, const Vector2d& from,
                                          const Vector2d& xy) const {
  std::vector<SeenPoint> points;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& one : seen(barriers, from)) {
    const Vector2d at = surface_.points()[one.point].head<2>();
    const double value = values[static_cast<std::size_t>(one.point)];
    points.push_back({{at.x(), at.y(), value}, one.away});
    least = std::min(least, value);
  }
  if (points.empty()) return std::nullopt;
  return std::max(LocalFit(points, bin_size_).at(xy), least / 2);
}

std::pair<double, double> SidedPoints::depths_near(const Vector2d& from) const {
  constexpr std::size_t kNear = 12;
  const auto all = static_cast<double>(extent_ + (from - low_).norm());
  std::vector<Candidate> near;
  for (double within = 3 * bin_size_; near.size() < kNear; within *= 2) {
    near = nearest(from, within);
    if (within > all) break;
  }
  std::pair<double, double> range = {std::numeric_limits<double>::infinity(),
                                     -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < std::min(near.size(), kNear); ++k) {
    const double z = surface_.points()[near[k].point].z();
    range = {std::min(range.first, z), std::max(range.second, z)};
  }
  return range;
}

}  // namespace faultsim::horizons
