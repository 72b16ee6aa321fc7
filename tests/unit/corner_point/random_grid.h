#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "made_grid.h"

namespace faultsim::corner_point {

/// A grid of 1 to 4 random faults, some inactive cells, layers of 0 to 20 m. Equal seeds give equal
/// grids.
class RandomGrid {
 public:
  explicit RandomGrid(unsigned seed) : random_(seed) {
    grid_.size = {whole(18, 36), whole(16, 30), whole(1, 5)};
    grid_.dx = number(50, 150);
    grid_.dy = number(50, 150);
    grid_.lean = {number(-1, 1), number(-1, 1)};
    grid_.is_left_handed = whole(0, 1) == 1;
    grid_.thickness.clear();
    for (int k = 0; k < grid_.size[2]; ++k) grid_.thickness.push_back(number(0, 20));
    const int n_faults = whole(1, 4);
    for (int f = 0; f < n_faults; ++f) grid_.faults.push_back(fault(f));
    for (int c = whole(0, 20); c > 0; --c)
      grid_.inactive.push_back(
          {whole(0, grid_.size[0] - 1), whole(0, grid_.size[1] - 1), whole(0, grid_.size[2] - 1)});
  }
  const MadeGrid& grid() const { return grid_; }

 private:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  /// Through a place in the middle; offsets of 10 to 100 m, over all of it or to tips.
  MadeFault fault(int f) {
    const double width = grid_.dx * grid_.size[0],
                 height = (grid_.is_left_handed ? -1 : 1) * grid_.dy * grid_.size[1];
    const Eigen::Vector2d middle(width * number(0.25, 0.75), height * number(0.25, 0.75));
    const double angle = number(0, 2 * std::numbers::pi), half = 0.5 * number(0.4, 1.5) * width;
    const Eigen::Vector2d along = half * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const double most = number(10, 100);
    MadeFault fault{middle - along, middle + along};
    fault.offset = [most](double s) {
      return most * std::clamp(5 * std::min(s, 1 - s), 0.0, 1.0);  // tapers over a fifth
    };
    if (f > 0 && whole(0, 2) == 0) fault.only_right_of = 0;
    return fault;
  }

  std::mt19937 random_;
  MadeGrid grid_;
};

}  // namespace faultsim::corner_point
