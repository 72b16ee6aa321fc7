#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace faultsim::horizons {

/// Stretches in the map that nothing is to be interpolated across.
class MapBarriers {
 public:
  using Stretch = std::array<Eigen::Vector2d, 2>;

  explicit MapBarriers(std::vector<Stretch> stretches);
  /// Whether the way from a to b touches or crosses one.
  bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Whether one sees the other: on the straight way, or on one with a knee, 4 percent longer.
  /// Neighbours along the outer side of a trace that bends hide each other on the straight way.
  bool sees(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
  /// Whether one is nearer than that.
  bool is_within(const Eigen::Vector2d& place, double away) const;

 private:
  int bin(double x, int axis) const;
  const std::vector<int>& in_bin(int i, int j) const { return bins_[j * n_bins_ + i]; }

  std::vector<Stretch> stretches_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero(), high_ = low_, bin_size_ = low_;
  int n_bins_ = 0;                      ///< along each axis.
  std::vector<std::vector<int>> bins_;  ///< stretches whose box touches the bin.
};

}  // namespace faultsim::horizons
