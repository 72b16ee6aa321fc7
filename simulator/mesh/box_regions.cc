#include <algorithm>
#include <cmath>

#include "simulator/mesh/box_layout.h"

namespace faultsim {
namespace {

/// ∫₀^x √(r² − t²) dt
double half_disc_integral(double r, double x) {
  const double inside = std::clamp(x, -r, r);
  return 0.5 * (inside * std::sqrt(std::max(r * r - inside * inside, 0.0)) +
                r * r * std::asin(inside / r));
}

/// Index range [first, last) of the cells of a line that overlap [from, to].
std::array<size_t, 2> overlapping_cells(const std::vector<double>& line, double from, double to) {
  const size_t n = line.size() - 1;
  size_t first = 0, last = n;
  while (first < n && line[first + 1] <= from) ++first;
  while (last > first && line[last - 1] >= to) --last;
  return {first, last};
}

double overlap(double a0, double a1, double b0, double b1) {
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

/// Region edges are grid lines but for rounding and merging: shares so close to 0 or 1 are that.
double snapped(double fraction) {
  constexpr double kRounding = 1e-6;
  if (fraction < kRounding) return 0;
  return fraction > 1 - kRounding ? 1 : fraction;
}

}  // namespace

double disc_rectangle_area(double radius, double x0, double x1, double y0, double y1) {
  // The height of the part at x is min(y1, s) − max(y0, −s), s = √(r² − x²): between the places
  // where a branch changes, each term is a constant or ± s.
  std::vector<double> cuts = {std::max(x0, -radius), std::min(x1, radius)};
  if (!(cuts[0] < cuts[1])) return 0;
  for (const double y : {y0, y1})
    if (std::abs(y) < radius) {
      const double x = std::sqrt((radius - y) * (radius + y));
      for (const double cut : {-x, x})
        if (cut > cuts[0] && cut < cuts[1]) cuts.push_back(cut);
    }
  std::ranges::sort(cuts);
  double area = 0;
  for (size_t k = 0; k + 1 < cuts.size(); ++k) {
    const double a = cuts[k], b = cuts[k + 1], middle = 0.5 * (a + b);
    const double s = std::sqrt(std::max(radius * radius - middle * middle, 0.0));
    if (std::min(y1, s) <= std::max(y0, -s)) continue;
    const double arc = half_disc_integral(radius, b) - half_disc_integral(radius, a);
    area += (y1 < s ? y1 * (b - a) : arc) - (y0 > -s ? y0 * (b - a) : -arc);
  }
  return area;
}

CellRegions cell_regions(const BoxMeshSpec& spec, const GridLines& lines) {
  const size_t nx = lines[0].size() - 1, ny = lines[1].size() - 1, nz = lines[2].size() - 1;
  CellRegions cells;
  cells.region.assign(nx * ny * nz, -1);
  cells.fraction.assign(nx * ny * nz, 0.0);
  for (size_t n = 0; n < spec.regions.size(); ++n) {
    const PressureRegion& region = spec.regions[n];
    const auto [low, high] = bounds_of(region);
    std::array<std::array<size_t, 2>, 3> range;
    for (size_t d = 0; d < 3; ++d) range[d] = overlapping_cells(lines[d], low[d], high[d]);
    const auto share = [&, &from = low, &to = high](size_t d, size_t i) {
      const double a = lines[d][i], b = lines[d][i + 1];
      return overlap(a, b, from[d], to[d]) / (b - a);
    };
    for (size_t j = range[1][0]; j < range[1][1]; ++j)
      for (size_t i = range[0][0]; i < range[0][1]; ++i) {
        double plan_share = share(0, i) * share(1, j);
        if (region.shape == RegionShape::disc) {
          const double x0 = lines[0][i], x1 = lines[0][i + 1], y0 = lines[1][j],
                       y1 = lines[1][j + 1];
          plan_share =
              disc_rectangle_area(region.radius, x0 - region.center[0], x1 - region.center[0],
                                  y0 - region.center[1], y1 - region.center[1]) /
              ((x1 - x0) * (y1 - y0));
        }
        for (size_t k = range[2][0]; k < range[2][1]; ++k) {
          const double fraction = snapped(plan_share * share(2, k));
          const size_t cell = i + nx * (j + ny * k);
          if (fraction <= cells.fraction[cell]) continue;
          cells.region[cell] = static_cast<int>(n);
          cells.fraction[cell] = fraction;
        }
      }
  }
  return cells;
}

}  // namespace faultsim
