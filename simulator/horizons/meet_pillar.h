#pragma once

namespace faultsim::horizons {

/// Where above(z) = z − depth(x(v, z)) is zero between low and high: by secants, which are exact on
/// planes, and halves. Horizons are less steep than pillars, so that there is one such z.
template <typename Above>
double meet_pillar(double low, double high, const Above& above) {
  constexpr int kSteps = 200;
  double at_low = above(low), at_high = above(high);
  if (at_low >= 0) return low;
  if (at_high <= 0) return high;
  for (int k = 0; k < kSteps; ++k) {
    const double secant = low - at_low * (high - low) / (at_high - at_low);
    const double z = k % 3 < 2 && secant > low && secant < high ? secant : (low + high) / 2;
    const double there = above(z);
    if (there == 0 || z == low || z == high) return z;
    (there < 0 ? low : high) = z;
    (there < 0 ? at_low : at_high) = there;
    if (high - low < 1e-9) break;
  }
  return low - at_low * (high - low) / (at_high - at_low);
}

}  // namespace faultsim::horizons
