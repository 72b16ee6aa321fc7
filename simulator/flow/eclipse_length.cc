#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

std::optional<double> eclipse_depth_ratio(const EclipseGrid& grid) {
  const auto n_i = static_cast<std::size_t>(grid.size[0]),
             n_j = static_cast<std::size_t>(grid.size[1]),
             n_k = static_cast<std::size_t>(grid.size[2]), n_cells = n_i * n_j * n_k;
  const bool has_active = grid.active.size() == n_cells;
  if (grid.zcorn.size() != 8 * n_cells || !(has_active || grid.active.empty())) return std::nullopt;
  std::vector<double> ratios;
  std::size_t n_active = 0;
  for (std::size_t cell = 0; cell < n_cells; ++cell) {
    if (has_active && grid.active[cell] == 0) continue;
    if (n_active >= grid.cell_depth.size()) return std::nullopt;
    const std::size_t i = cell % n_i, j = cell / n_i % n_j, k = cell / n_i / n_j;
    double depth = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const std::size_t x = 2 * i + corner % 2, y = 2 * j + corner / 2 % 2, z = 2 * k + corner / 4;
      depth += static_cast<double>(grid.zcorn[x + 2 * n_i * (y + 2 * n_j * z)]) / 8;
    }
    const double ratio = static_cast<double>(grid.cell_depth[n_active++]) / depth;
    if (std::isfinite(ratio)) ratios.push_back(ratio);
  }
  if (ratios.empty() || n_active != grid.cell_depth.size()) return std::nullopt;
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

EclipseLength eclipse_length(const EclipseGrid& grid, std::optional<double> depth_ratio) {
  const std::optional<double> said = eclipse_metre(grid.length_unit);
  const bool has_system =
      grid.unit_system >= 1 && grid.unit_system <= static_cast<int>(kSystems.size());
  if (!has_system) {
    if (said) return {*said, ""};
    return {1, "neither GRIDUNIT nor INTEHEAD says a unit of length: metres were taken"};
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
                       ", with which alone the depths of the cells (DEPTH) agree"};
  }
  return {metre,
          contradiction + "lengths were taken as " + metre_words(metre) +
              (is_ratio(1) ? ", with which alone the depths of the cells (DEPTH) agree" : "")};
}

}  // namespace faultsim
