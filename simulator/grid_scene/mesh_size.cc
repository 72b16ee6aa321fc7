#include "simulator/grid_scene/mesh_size.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/outline.h"
#include "simulator/horizons/layered_body.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::RemarkKind;

double length_of_outlines(const ModelLines& lines) {
  double length = 0;
  for (const Polyline& outline : lines.outlines)
    length += corner_point::line_length(closed(outline));
  return length;
}

/// The median over the columns of the active map of what is chosen of the sides of their tops,
/// along i and along j, m.
double median_of_sides(const corner_point::ColumnMap& map, const auto& side_of) {
  std::vector<double> all;
  const corner_point::CornerPointGrid& grid = map.grid();
  for (int column = 0; column < grid.n_columns(); ++column) {
    if (!map.is_inside(column)) continue;
    const int k = map.top_layer(column);
    const Eigen::Vector3d at = grid.corner(column, k, {});
    const double along = (grid.corner(column, k, {true, false, false}) - at).head<2>().norm(),
                 across = (grid.corner(column, k, {false, true, false}) - at).head<2>().norm();
    all.push_back(side_of(along, across));
  }
  const auto middle = all.begin() + std::ssize(all) / 2;
  std::ranges::nth_element(all, middle);
  return *middle;
}

}  // namespace

double median_cell(const corner_point::ColumnMap& map) {
  return median_of_sides(map, [](double along, double across) { return std::max(along, across); });
}

double outline_cell(const corner_point::ColumnMap& map) {
  constexpr double kMost = 1.5;
  const double shorter =
      median_of_sides(map, [](double along, double across) { return std::min(along, across); });
  return std::min(median_cell(map), kMost * shorter);
}

double mean_thickness(const corner_point::GridStructure& structure) {
  double volume = 0, area = 0;
  for (const corner_point::Compartment& one : structure.compartments) {
    volume += one.area * (one.mean_top - one.mean_base);
    area += one.area;
  }
  return volume / area;
}

MeshGrading grading_of(const corner_point::GridStructure& structure, const ModelLines& lines) {
  const double width = (lines.high - lines.low).minCoeff();
  // Cells of a thin layer get flat: 16 times as wide as high at most, on the whole.
  constexpr double kShare = 15, kFlat = 16, kRound = 100, kLeast = 500, kMost = 2000;
  const double size = std::min(width / kShare, kFlat * mean_thickness(structure));
  return {.largest = std::clamp(kRound * std::round(size / kRound), kLeast, kMost)};
}

double estimated_cells(const corner_point::GridStructure& structure, const ModelLines& lines,
                       double strike) {
  const MeshGrading grading = grading_of(structure, lines);
  const double h = std::min(strike, grading.largest), g = grading.growth;
  const double dividers = horizons::BodyCells{.at_faults = h}.beside_dividers();
  constexpr double kTriangle = 0.45;    // of a size squared, measured
  constexpr double kFaultHeight = 500;  // m, of what is fine in depth
  const auto beside = [&](double length, double size) {
    const double first = std::min(size, grading.largest);
    return 2 * length / (kTriangle * g) * (1 / first - 1 / grading.largest) +
           length / (kTriangle * first);
  };
  double faults = 0;
  for (const corner_point::Fault& fault : structure.faults) faults += fault.length;
  const auto levels = [&](double size) {
    const double first = std::min(size, grading.largest);
    return kFaultHeight / first + 2 / g * std::log(grading.largest / first) +
           -lines.base / grading.largest / 2 + 3;
  };
  const Eigen::Vector2d box = lines.high - lines.low;
  const double far = box.x() * box.y() / (kTriangle * grading.largest * grading.largest);
  return 3 * (beside(faults, h) * levels(1.5 * h) +
              beside(length_of_outlines(lines), dividers) * levels(dividers) +
              far * levels(grading.largest));
}

double chosen_strike(const corner_point::GridStructure& structure, const ModelLines& lines,
                     double cell, const LineOptions& options, Remarks& remarks) {
  constexpr double kLargest = 1.5;  // cells
  double half = cell / 2;
  for (const corner_point::Fault& fault : structure.faults) half = std::min(half, fault.cell / 2);
  const double wanted = std::max(1.0, std::round(half));
  double strike = options.strike > 0 ? options.strike : wanted;
  while (options.strike == 0 && estimated_cells(structure, lines, strike) > options.n_cells &&
         strike < kLargest * cell)
    strike = std::ceil(1.05 * strike);
  const std::string why = options.strike > 0 ? "as asked for"
                          : strike == wanted
                              ? "half a cell of the grid"
                              : formatted(
                                    "half a cell of the grid, %.0f m, would "
                                    "make about %.2g tetrahedra",
                                    wanted, estimated_cells(structure, lines, wanted));
  remarks.push_back({RemarkKind::choice,
                     formatted("cells at the faults are %.0f m wide (%s): about %.2g tetrahedra",
                               strike, why.c_str(), estimated_cells(structure, lines, strike)),
                     "/mesh/strike"});
  return strike;
}

}  // namespace faultsim::grid_scene
