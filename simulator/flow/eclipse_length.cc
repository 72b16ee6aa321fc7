#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/flow/eclipse_grid.h"

namespace faultsim {
namespace {

/// METRIC, FIELD, LAB, PVT-M of INTEHEAD, from 1.
constexpr std::array kSystems = {"METRIC", "FIELD", "LAB", "PVT-M"};
constexpr std::array kSystemMetres = {1.0, 0.3048, 0.01, 1.0};

std::string metre_words(double metre) {
  return metre == 1 ? "metres" : metre == 0.01 ? "centimetres" : "feet";
}

/// Mean depth of the corners of a cell, in the unit of the file.
double middle_depth(const EclipseGrid& grid, std::size_t cell) {
  const auto nx = static_cast<std::size_t>(grid.size[0]),
             ny = static_cast<std::size_t>(grid.size[1]);
  const std::size_t i = cell % nx, j = cell / nx % ny, k = cell / (nx * ny);
  double depth = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t column = 2 * i + corner % 2, row = 2 * j + corner / 2 % 2,
                      level = 2 * k + corner / 4;
    depth += static_cast<double>(grid.zcorn[(level * 2 * ny + row) * 2 * nx + column]) / 8;
  }
  return depth;
}

}  // namespace

std::optional<double> depth_ratio(const EclipseGrid& grid) {
  const auto n_of = [&](std::size_t axis) { return static_cast<std::size_t>(grid.size[axis]); };
  const std::size_t n_cells = n_of(0) * n_of(1) * n_of(2);
  if (grid.zcorn.size() != 8 * n_cells) return std::nullopt;
  const auto is_active = [&](std::size_t cell) {
    return grid.active.empty() || (cell < grid.active.size() && grid.active[cell] != 0);
  };
  std::vector<double> ratios;
  std::size_t active = 0;
  for (std::size_t cell = 0; cell < n_cells; ++cell) {
    if (!is_active(cell)) continue;
    if (active >= grid.cell_depth.size()) return std::nullopt;  // of another grid, or none
    const double ratio = static_cast<double>(grid.cell_depth[active++]) / middle_depth(grid, cell);
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  if (active != grid.cell_depth.size() || ratios.empty()) return std::nullopt;
  const auto middle = ratios.begin() + std::ssize(ratios) / 2;
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

std::optional<double> eclipse_metre(const std::string& unit) {
  if (unit.rfind("METRES", 0) == 0) return 1;
  if (unit.rfind("FEET", 0) == 0) return 0.3048;
  if (unit.rfind("CM", 0) == 0) return 0.01;
  return std::nullopt;
}

bool are_no_axes(const std::vector<float>& map_axes) {
  return std::ranges::all_of(map_axes, [](float number) { return number == 0; });
}

std::string axes_misfit(const std::vector<float>& map_axes) {
  const auto from_origin = [&](std::size_t i) {
    return Eigen::Vector2d(static_cast<double>(map_axes[i]) - static_cast<double>(map_axes[2]),
                           static_cast<double>(map_axes[i + 1]) - static_cast<double>(map_axes[3]));
  };
  const Eigen::Vector2d y = from_origin(0), x = from_origin(4);
  // Single precision does not tell points a foot apart from each other at 20 million feet.
  if (x.norm() == 0 || y.norm() == 0) return "have no length: points on them are the origin";
  constexpr double kLeastSine = 0.99;  // of the angle between them
  const double sine = std::abs(x.x() * y.y() - x.y() * y.x()) / (x.norm() * y.norm());
  return sine > kLeastSine ? "" : "are not at right angles to each other";
}

EclipseLength eclipse_length(const EclipseGrid& grid, std::optional<double> depth_ratio) {
  const std::optional<double> said = eclipse_metre(grid.length_unit);
  const bool has_system =
      grid.unit_system >= 1 && grid.unit_system <= static_cast<int>(kSystems.size());
  if (!has_system) {
    if (said) return {*said, ""};
    return {1, "neither GRIDUNIT nor INTEHEAD gives a unit of length: metres were assumed"};
  }
  const double metre = kSystemMetres[grid.unit_system - 1];
  if (!said || *said == metre) return {metre, ""};
  const std::string contradiction =
      concat("GRIDUNIT says ", grid.length_unit, ", INTEHEAD of ", grid.unit_file, " ",
             kSystems[grid.unit_system - 1], ": ");
  constexpr double kSame = 0.01;
  const auto is_ratio = [&](double ratio) {
    return depth_ratio && std::abs(*depth_ratio / ratio - 1) < kSame;
  };
  if (is_ratio(*said / metre)) {
    return {*said, contradiction + "lengths were taken as " + metre_words(*said) +
                       ", with which alone the cells' depths (DEPTH) agree"};
  }
  return {metre, contradiction + "lengths were taken as " + metre_words(metre) +
                     (is_ratio(1) ? ", with which alone the cells' depths (DEPTH) agree" : "")};
}

}  // namespace faultsim
