#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace faultsim::horizons {

/// A point of a horizon as seen from a place.
struct SeenPoint {
  Eigen::Vector3d at;
  double away;  ///< from the place, m.
};

/// A polynomial in x, y through the depths of points near a place.
///
/// Of second order with kForSecond points or more that reach twice as far as the nearest one is
/// away; of first order otherwise; along one line only where they stand on one; constant of a
/// single one. Least squares of (depth − polynomial) / (away² + (R / 100)²), R how far the points
/// reach, so that a point at the place is met. Further than R, and than `farthest`, from the
/// nearest point it keeps what it has there: it does not run off. Nor does it where points bend
/// sharply, as beside a step that no fault is drawn at: it leaves the range of their depths, and of
/// their plane of first order, by a quarter of that range at most. After D. H. McLain, Drawing
/// contours from arbitrary data points, Computer J. 17, 1974.
class LocalFit {
 public:
  static constexpr std::size_t kForSecond = 9;

  /// @param points  at least one, the nearest first.
  /// @param farthest  m, > 0.
  explicit LocalFit(const std::vector<SeenPoint>& points,
                    double farthest = std::numeric_limits<double>::infinity());
  double at(const Eigen::Vector2d& place) const;

 private:
  static constexpr int kTerms = 6;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  Terms terms_at(const Eigen::Vector2d& place) const;

  Eigen::Vector3d nearest_;
  double farthest_;
  double reach_ = 0;                                    ///< R, m.
  Eigen::Matrix2d axes_ = Eigen::Matrix2d::Identity();  ///< rows: along the points, across.
  Terms factors_ = Terms::Zero();  ///< of 1, u, v, u², u v, v² with (u, v) over R.
  Terms plane_ = Terms::Zero();    ///< of first order.
  double low_ = 0, high_ = 0;      ///< of the points' depths, m from the nearest one's.
};

}  // namespace faultsim::horizons
