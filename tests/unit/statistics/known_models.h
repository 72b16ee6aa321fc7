#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

/// Functions whose sensitivity indices are known.
namespace faultsweep::testing {

using Point = std::array<double, 3>;  ///< uniform in [0, 1).
using Model = std::function<double(const Point&)>;

/// Ishigami & Homma (1990), a = 7, b = 0.1, its coordinates in the order given.
inline Model ishigami(int first, int second, int third) {
  return [=](const Point& p) {
    const auto angle = [&](int k) {
      return std::numbers::pi * (2 * p[static_cast<std::size_t>(k)] - 1);
    };
    return std::sin(angle(first)) + 7 * std::pow(std::sin(angle(second)), 2) +
           0.1 * std::pow(angle(third), 4) * std::sin(angle(first));
  };
}

}  // namespace faultsweep::testing
