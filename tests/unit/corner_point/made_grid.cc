#include "made_grid.h"

#include <algorithm>
#include <cmath>

namespace faultsim::corner_point {
namespace {

Eigen::Vector2d pillar_at(const MadeGrid& grid, double i, double j) {
  return {i * grid.dx, (grid.is_left_handed ? -1 : 1) * j * grid.dy};
}

bool is_right(const MadeFault& fault, const Eigen::Vector2d& at) {
  const Eigen::Vector2d along = fault.to - fault.from, away = at - fault.from;
  return along.x() * away.y() - along.y() * away.x() < 0;
}

double lowered_by(const MadeGrid& grid, const MadeFault& fault, const Eigen::Vector2d& column,
                  const Eigen::Vector2d& pillar) {
  if (!is_right(fault, column)) return 0;
  if (fault.only_right_of >= 0 &&
      !is_right(grid.faults[static_cast<std::size_t>(fault.only_right_of)], column))
    return 0;
  const Eigen::Vector2d along = fault.to - fault.from;
  return fault.offset((pillar - fault.from).dot(along) / along.squaredNorm());
}

}  // namespace

double made_top(const Eigen::Vector2d& at) {
  return -2000 + 0.02 * at.x() - 0.01 * at.y() + 15 * std::sin(at.x() / 700);
}

CornerPointGrid made(const MadeGrid& grid) {
  CornerPointGrid all;
  all.size = grid.size;
  const auto [n_i, n_j, n_k] = grid.size;
  const double length = 500;
  for (int j = 0; j <= n_j; ++j) {
    for (int i = 0; i <= n_i; ++i) {
      const Eigen::Vector2d at = pillar_at(grid, i, j);
      const Eigen::Vector2d top = at - length * grid.lean, bottom = at + length * grid.lean;
      all.pillars.push_back({{top.x(), top.y(), grid.reference + length},
                             {bottom.x(), bottom.y(), grid.reference - length}});
    }
  }
  for (int plane = 0; plane < 2 * n_k; ++plane) {
    double above = 0;
    for (int k = 0; k < (plane + 1) / 2; ++k) above += grid.thickness[static_cast<std::size_t>(k)];
    for (int row = 0; row < 2 * n_j; ++row) {
      for (int place = 0; place < 2 * n_i; ++place) {
        const Eigen::Vector2d pillar = pillar_at(grid, (place + 1) / 2, (row + 1) / 2),
                              column = pillar_at(grid, place / 2 + 0.5, row / 2 + 0.5);
        double z = made_top(pillar) - above;
        for (const MadeFault& fault : grid.faults) z -= lowered_by(grid, fault, column, pillar);
        all.corner_z.push_back(z);
      }
    }
  }
  all.is_active.assign(static_cast<std::size_t>(n_i * n_j * n_k), 1);
  for (const auto& [i, j, k] : grid.inactive) {
    for (int layer = 0; layer < n_k; ++layer) {
      if (k < 0 || k == layer)
        all.is_active[static_cast<std::size_t>(i + n_i * (j + n_j * layer))] = 0;
    }
  }
  return all;
}

EclipseGrid as_file(const CornerPointGrid& grid, double metre) {
  EclipseGrid file;
  file.size = grid.size;
  for (const Pillar& pillar : grid.pillars) {
    for (const Eigen::Vector3d& point : {pillar.top, pillar.bottom}) {
      for (int c = 0; c < 3; ++c)
        file.coord.push_back(static_cast<float>((c == 2 ? -1 : 1) * point[c] / metre));
    }
  }
  for (const double z : grid.corner_z) file.zcorn.push_back(static_cast<float>(-z / metre));
  for (const char active : grid.is_active) file.active.push_back(active);
  return file;
}

double distance_from_line(const MadeFault& fault, const Eigen::Vector2d& at) {
  const Eigen::Vector2d along = (fault.to - fault.from).normalized(), away = at - fault.from;
  return std::abs(along.x() * away.y() - along.y() * away.x());
}

double distance_from(const MadeFault& fault, const Eigen::Vector2d& at) {
  const Eigen::Vector2d along = fault.to - fault.from;
  const double s = std::clamp((at - fault.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (at - fault.from - s * along).norm();
}

}  // namespace faultsim::corner_point
