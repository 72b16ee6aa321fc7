#pragma once

#include <array>
#include <vector>

namespace faultsim {

/// Cells beyond a fault's rim that are still sheared with it.
inline constexpr double kShearMargin = 2;

/// A fault plane as a grid line of one axis that is bent onto the plane:
///
///   shift(b, c) = Σ_d slope_d (clamp(x_d, low_d, high_d) − pivot_d),   d the two other axes.
///
/// Within [low, high] the surface ref + shift is the plane exactly; beyond it goes on straight.
struct BentPlane {
  double ref = 0;  ///< m, where the grid line lies before bending.
  std::array<double, 2> slope = {0, 0};
  std::array<double, 2> pivot = {0, 0};
  std::array<double, 2> low = {0, 0};
  std::array<double, 2> high = {0, 0};

  double shift(double b, double c) const;
};

/// The shift of the whole grid along one axis: that of the planes at their places, linear between
/// them, zero at both sides of the body.
class Shear {
 public:
  /// @param planes  ascending in ref, strictly inside (from, to).
  Shear(double from, double to, std::vector<BentPlane> planes);
  const std::vector<BentPlane>& planes() const { return planes_; }

  /// Shifts of lines `ref` (ascending) at one place of the other two axes; out has their number.
  void shifts(const std::vector<double>& ref, double b, double c, std::vector<double>& out) const;

  /// Index k of the first gap (between plane k−1, or the near side for k = 0, and plane k, or the
  /// far side) that is somewhere in the ranges squeezed to less than kLeastGap of its width; −1 =
  /// none.
  int first_squeezed_gap(const std::array<double, 2>& range_b,
                         const std::array<double, 2>& range_c) const;

  static constexpr double kLeastGap = 0.2;

 private:
  double from_, to_;
  std::vector<BentPlane> planes_;
};

}  // namespace faultsim
