#include "simulator/corner_point/corner_point_grid.h"

#include <algorithm>
#include <cmath>

namespace faultsim::corner_point {

Eigen::Vector2d Pillar::at(double z) const {
  const double height = bottom.z() - top.z();
  if (height == 0) return top.head<2>();
  return top.head<2>() + (z - top.z()) / height * (bottom - top).head<2>();
}

std::size_t CornerPointGrid::corner_index(int column, int k, CornerPlace corner) const {
  const auto n_i = static_cast<std::size_t>(size[0]), n_j = static_cast<std::size_t>(size[1]);
  const auto at = static_cast<std::size_t>(column), layer = static_cast<std::size_t>(k);
  const std::size_t plane = 2 * layer + (corner.bottom ? 1 : 0);
  const std::size_t row = 2 * (at / n_i) + (corner.back ? 1 : 0);
  return (plane * 2 * n_j + row) * 2 * n_i + 2 * (at % n_i) + (corner.right ? 1 : 0);
}

int CornerPointGrid::pillar_of(int column, CornerPlace corner) const {
  const std::array<int, 2> at = place(column);
  return pillar(at[0] + (corner.right ? 1 : 0), at[1] + (corner.back ? 1 : 0));
}

Eigen::Vector3d CornerPointGrid::corner(int column, int k, CornerPlace corner) const {
  const double height = z(column, k, corner);
  const Eigen::Vector2d at = pillars[pillar_of(column, corner)].at(height);
  return {at.x(), at.y(), height};
}

bool CornerPointGrid::has_active_cell(int column) const {
  for (int k = 0; k < size[2]; ++k) {
    if (is_active[cell(column, k)] != 0) return true;
  }
  return false;
}

bool CornerPointGrid::is_inverted(int column, int k) const {
  constexpr double kRounding = 1e-3;  // m
  return std::ranges::any_of(kTopCorners, [&](const CornerPlace& top) {
    return z(column, k, {top.right, top.back, true}) > z(column, k, top) + kRounding;
  });
}

double CornerPointGrid::thickness(int column, int k) const {
  double sum = 0;
  for (const CornerPlace& top : kTopCorners)
    sum += z(column, k, top) - z(column, k, {top.right, top.back, true});
  return sum / 4;
}

double CornerPointGrid::largest_thickness(int column, int k) const {
  double largest = 0;
  for (const CornerPlace& top : kTopCorners)
    largest = std::max(largest, z(column, k, top) - z(column, k, {top.right, top.back, true}));
  return largest;
}

}  // namespace faultsim::corner_point
