#include "simulator/plan/reservoir_cells.h"

#include <vector>

#include "simulator/scene/field_depths.h"

namespace faultsim {
namespace {

/// Intervals between lines whose middle lies between two coordinates.
double intervals(const std::vector<double>& lines, double from, double to) {
  int n = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const double middle = 0.5 * (lines[i - 1] + lines[i]);
    n += middle > from && middle < to;
  }
  return n;
}

}  // namespace

double reservoir_cells(const Scene& scene, const GridLines& lines, bool plane_strain) {
  const auto box = [&](double x0, double x1, double y0, double y1, double z0, double z1) {
    const double along = plane_strain ? 1 : intervals(lines.y, y0, y1);
    return intervals(lines.x, x0, x1) * along * intervals(lines.z, z0, z1);
  };
  double n = 0;
  if (scene.geometry_kind == GeometryKind::field) {
    const double half = scene.field.block_length / 2;
    for (const Block& block : scene.field.blocks) {
      const DepthInterval range = reservoir_range(scene.field, block);
      n += box(block.from, block.to, -half, half, -range.bottom, -range.top);
    }
    return n;
  }
  for (const PressureRegion& region : scene.box.regions) {
    if (region.shape == RegionShape::box) {
      n += box(region.from[0], region.to[0], region.from[1], region.to[1], region.from[2],
               region.to[2]);
      continue;
    }
    constexpr double kDiscOfSquare = 0.785;  // pi/4
    const std::array<double, 3>& c = region.center;
    n += kDiscOfSquare * box(c[0] - region.radius, c[0] + region.radius, c[1] - region.radius,
                             c[1] + region.radius, c[2] - region.thickness / 2,
                             c[2] + region.thickness / 2);
  }
  return n;
}

}  // namespace faultsim
