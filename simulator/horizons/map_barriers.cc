#include "simulator/horizons/map_barriers.h"

#include <algorithm>
#include <cmath>

#include "simulator/horizons/traces.h"

namespace faultsim::horizons {

using Eigen::Vector2d;

MapBarriers::MapBarriers(std::vector<Stretch> stretches) : stretches_(std::move(stretches)) {
  if (stretches_.empty()) return;
  low_ = high_ = stretches_.front()[0];
  for (const Stretch& one : stretches_)
    for (const Vector2d& at : one) {
      low_ = low_.cwiseMin(at);
      high_ = high_.cwiseMax(at);
    }
  constexpr int kMostBins = 128;
  n_bins_ = std::min(kMostBins, static_cast<int>(stretches_.size()));
  bin_size_ = ((high_ - low_) / n_bins_).cwiseMax(1e-30);
  bins_.resize(static_cast<std::size_t>(n_bins_) * static_cast<std::size_t>(n_bins_));
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const auto& [a, b] = stretches_[k];
    const Vector2d from = a.cwiseMin(b), to = a.cwiseMax(b);
    for (int j = bin(from.y(), 1); j <= bin(to.y(), 1); ++j)
      for (int i = bin(from.x(), 0); i <= bin(to.x(), 0); ++i)
        bins_[j * n_bins_ + i].push_back(static_cast<int>(k));
  }
}

int MapBarriers::bin(double x, int axis) const {
  return static_cast<int>(std::clamp((x - low_[axis]) / bin_size_[axis], 0.0, n_bins_ - 1.0));
}

bool MapBarriers::cross(const Vector2d& a, const Vector2d& b) const {
  const Vector2d from = a.cwiseMin(b), to = a.cwiseMax(b);
  if ((low_ - to).maxCoeff() > 0 || (from - high_).maxCoeff() > 0) return false;
  const auto is_crossed = [&](int k) {
    return crossing_of(a, b, stretches_[k][0], stretches_[k][1]).allFinite();
  };
  const double run = b.x() - a.x();
  for (int i = bin(from.x(), 0); i <= bin(to.x(), 0); ++i) {
    // The part of the way over this column of bins, with a margin for rounding.
    double low = from.y(), high = to.y();
    if (std::abs(run) > bin_size_.x()) {
      const auto y_at = [&](double x) {
        return a.y() + (std::clamp(x, from.x(), to.x()) - a.x()) / run * (b.y() - a.y());
      };
      const double y0 = y_at(low_.x() + (i - 0.01) * bin_size_.x());
      const double y1 = y_at(low_.x() + (i + 1.01) * bin_size_.x());
      low = std::min(y0, y1);
      high = std::max(y0, y1);
    }
    for (int j = bin(low, 1); j <= bin(high, 1); ++j)
      if (std::ranges::any_of(in_bin(i, j), is_crossed)) return true;
  }
  return false;
}

bool MapBarriers::sees(const Vector2d& a, const Vector2d& b) const {
  if (n_bins_ == 0 || !cross(a, b)) return true;
  constexpr double kKnee = 0.15;  // of the way, to its side
  const Vector2d side(-(b - a).y(), (b - a).x());
  return std::ranges::any_of(std::array<double, 2>{-kKnee, kKnee}, [&](double knee) {
    const Vector2d over = (a + b) / 2 + knee * side;
    return !cross(a, over) && !cross(over, b);
  });
}

bool MapBarriers::is_within(const Vector2d& place, double away) const {
  const Vector2d from = place.array() - away, to = place.array() + away;
  if (n_bins_ == 0 || (low_ - to).maxCoeff() > 0 || (from - high_).maxCoeff() > 0) return false;
  const auto is_near = [&](int k) {
    return nearest_on_line({stretches_[k][0], stretches_[k][1]}, place).distance < away;
  };
  for (int j = bin(from.y(), 1); j <= bin(to.y(), 1); ++j)
    for (int i = bin(from.x(), 0); i <= bin(to.x(), 0); ++i)
      if (std::ranges::any_of(in_bin(i, j), is_near)) return true;
  return false;
}

}  // namespace faultsim::horizons
