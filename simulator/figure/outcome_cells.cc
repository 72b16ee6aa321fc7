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
                const std::vector<std::string>& words, int most_parts) {
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
  return {axis, {}, most_parts};
}

std::string share_text(const MapCell& cell) {
  const long n = cell.n_known();
  if (n == 0) return "";
  const auto percent = [n](long part) {
    if (part == 0) return 0L;
    if (part == n) return 100L;
    return std::clamp(std::lround(100.0 * static_cast<double>(part) / static_cast<double>(n)), 1L,
                      99L);
  };
  const long low = percent(cell.n_slide()), high = percent(cell.n_slide() + cell.n_undecided());
  return cell.n_undecided() == 0 ? std::to_string(low) : concat(low, "–", high);
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
