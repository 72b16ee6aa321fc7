#include "simulator/figure/outcome_cells.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/ranges.h"
#include "simulator/common/text.h"

namespace faultsim::figure {
namespace {

constexpr std::size_t kMostLevels = 16;

/// The different values, ascending; empty where there are more than kMostLevels.
std::vector<double> levels_of(const std::vector<double>& values) {
  std::vector<double> levels;
  for (const double value : values) {
    const auto at = std::ranges::lower_bound(levels, value);
    if (at != levels.end() && *at == value) continue;
    if (levels.size() == kMostLevels) return {};
    levels.insert(at, value);
  }
  return levels;
}

/// Ticks of columns: every so many that there are at most kMostLevels.
std::vector<Tick> ticks_of(const std::vector<std::string>& names) {
  const std::size_t step = (names.size() + kMostLevels - 1) / std::max<std::size_t>(kMostLevels, 1);
  std::vector<Tick> ticks;
  for (std::size_t k = 0; k < names.size(); k += std::max<std::size_t>(step, 1))
    ticks.push_back({static_cast<double>(k), names[k]});
  return ticks;
}

/// Columns 0, 1, … with these names.
Axis axis_of_columns(const std::string& label, const std::vector<std::string>& names) {
  return {label, -0.5, static_cast<double>(names.size()) - 0.5, ticks_of(names)};
}

/// With the digits that tell the values apart.
std::vector<std::string> names_of(const std::vector<double>& levels) {
  constexpr int kMostDigits = 6;
  std::vector<std::string> names;
  for (int digits = 3; digits <= kMostDigits; ++digits) {
    names = mapped(levels, [&](double value) { return plain_number(value, digits); });
    if (std::ranges::adjacent_find(names) == names.end()) break;
  }
  return names;
}

}  // namespace

int MapSide::cell_of(double value) const {
  if (levels.empty()) return std::clamp(static_cast<int>(axis.share(value) * n), 0, n - 1);
  const auto at = std::ranges::lower_bound(levels, value);
  return std::min(static_cast<int>(at - levels.begin()), n - 1);
}

double MapSide::place_of(double value) const {
  if (levels.empty()) return value;
  const auto above = std::ranges::lower_bound(levels, value);
  if (above == levels.end()) return static_cast<double>(levels.size() - 1);
  const double k = static_cast<double>(above - levels.begin());
  if (*above == value || above == levels.begin()) return k;
  return k - (*above - value) / (*above - *(above - 1));
}

MapSide side_of(const std::string& label, const std::vector<double>& values,
                const std::vector<std::string>& words) {
  constexpr std::size_t kMostWords = 48;
  if (!words.empty() && words.size() <= kMostWords) {
    MapSide side{axis_of_columns(label, words), {}, static_cast<int>(words.size())};
    for (std::size_t k = 0; k < words.size(); ++k) side.levels.push_back(static_cast<double>(k));
    return side;
  }
  const std::vector<double> levels = words.empty() ? levels_of(values) : std::vector<double>();
  if (!levels.empty())
    return {axis_of_columns(label, names_of(levels)), levels, static_cast<int>(levels.size())};
  Axis axis = axis_over(label, values, {}, 6);
  if (!words.empty()) {  // too many for columns of their own: the axis counts them
    axis = axis_of_columns(label, words);
  }
  return {axis};
}

CellGrid counted(const OutcomeMap& map) {
  constexpr double kCasesPerCell = 10, kMostColumns = 20, kMostRows = 14;
  const double n_cells = static_cast<double>(map.x.size()) / kCasesPerCell;
  const auto parts = [](double wanted, double most) {
    return static_cast<int>(std::clamp(std::round(wanted), 3.0, most));
  };
  CellGrid grid{
      side_of(map.x_label, map.x, map.x_words), side_of(map.y_label, map.y, map.y_words), {}};
  const bool parts_x = grid.x.has_parts(), parts_y = grid.y.has_parts();
  if (parts_x)
    grid.x.n = parts(parts_y ? std::sqrt(1.4 * n_cells) : n_cells / grid.y.n, kMostColumns);
  if (parts_y) grid.y.n = parts(parts_x ? std::sqrt(n_cells / 1.4) : n_cells / grid.x.n, kMostRows);
  grid.cells.resize(static_cast<std::size_t>(grid.x.n) * static_cast<std::size_t>(grid.y.n));
  for (std::size_t k = 0; k < map.x.size(); ++k) {
    const auto cell =
        static_cast<std::size_t>(grid.y.cell_of(map.y[k])) * static_cast<std::size_t>(grid.x.n) +
        static_cast<std::size_t>(grid.x.cell_of(map.x[k]));
    ++grid.cells[cell].counts[static_cast<std::size_t>(map.kind[k])];
  }
  return grid;
}

long few_cases(const CellGrid& grid) {
  constexpr long kFew = 5;
  return grid.x.has_parts() || grid.y.has_parts() ? kFew : 1;
}

std::string share_text(const MapCell& cell, long few) {
  const long n = cell.n_known();
  if (n == 0) return "";
  const auto shown = [n, few](long part) {
    if (n < few) return part;
    if (part == 0) return 0L;
    if (part == n) return 100L;
    return std::clamp(std::lround(100.0 * static_cast<double>(part) / static_cast<double>(n)), 1L,
                      99L);
  };
  const long low = shown(cell.n_slide()), high = shown(cell.n_slide() + cell.n_undecided());
  const std::string text = cell.n_undecided() == 0 ? std::to_string(low) : concat(low, "–", high);
  return n < few ? concat(text, " of ", n) : text;
}

bool would_overlap(std::vector<Point> points, double radius) {
  std::ranges::sort(points, {}, &Point::x);
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t i = k + 1; i < points.size() && points[i].x - points[k].x < 2 * radius; ++i) {
      if (std::hypot(points[i].x - points[k].x, points[i].y - points[k].y) < 2 * radius)
        return true;
    }
  }
  return false;
}

}  // namespace faultsim::figure
