#include "simulator/grid_scene/compartment_points.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/corner_point/straight_trace.h"
#include "simulator/grid_scene/line_check.h"
#include "simulator/grid_scene/outline.h"
#include "simulator/horizons/cut_map.h"

namespace faultsim::grid_scene {
namespace {

using corner_point::CornerPointGrid;
using corner_point::GridStructure;
using corner_point::RemarkKind;
using Eigen::Vector2d;

/// The middle of a column at the height of traces.
Vector2d middle_of(const CornerPointGrid& grid, int column, double z) {
  Vector2d sum(0, 0);
  for (const bool right : {false, true}) {
    for (const bool back : {false, true})
      sum += grid.pillars[grid.pillar_of(column, {right, back})].at(z) / 4;
  }
  return sum;
}

double distance_to_lines(const ModelLines& lines, const Vector2d& at) {
  double least = 1e300;
  for (const ModelFault& fault : lines.faults)
    least = std::min(least, corner_point::nearest_on_line(fault.trace, at).distance);
  for (const ModelDivider& divider : lines.dividers)
    least = std::min(least, corner_point::nearest_on_line(divider.line, at).distance);
  return least;
}

std::string number_of(const GridStructure& structure, int source) {
  return concat("compartment ", structure.compartments[source].region);
}

/// A column of the active map whose middle lies within the outlines.
struct PlacedColumn {
  Vector2d middle;
  std::vector<int> compartments;  ///< with active cells in it, ascending.
  int part = 0;
};

std::vector<PlacedColumn> placed_columns(const CornerPointGrid& grid,
                                         const GridStructure& structure, const ModelLines& lines) {
  std::map<int, std::set<int>> of_column;
  for (int c = 0; c < static_cast<int>(structure.compartments.size()); ++c)
    for (const int cell : structure.compartments[c].cells)
      of_column[cell % grid.n_columns()].insert(c);
  std::vector<PlacedColumn> placed;
  for (const auto& [column, compartments] : of_column) {
    const Vector2d middle = middle_of(grid, column, lines.reference_z);
    if (is_within(lines.outlines, middle))
      placed.push_back({middle, {compartments.begin(), compartments.end()}});
  }
  return placed;
}

/// Says which part of the map each column lies in. @returns false where lines do not fit.
bool find_parts(const ModelLines& lines, std::vector<PlacedColumn>& columns) {
  const horizons::LayeredBody body = body_of_lines(lines);
  std::vector<Problem> problems;
  const horizons::MapLines met = horizons::meeting_lines(body, problems);
  if (!problems.empty()) return false;
  const horizons::MapMesh map = horizons::mesh_map(body, met, problems);
  if (!problems.empty()) return false;
  const std::vector<int> parts = horizons::parts_between_lines(map);
  const std::vector<int> around =
      horizons::triangles_around(map, mapped(columns, &PlacedColumn::middle));
  for (std::size_t c = 0; c < columns.size(); ++c)
    columns[c].part = around[c] < 0 ? -1 : parts[around[c]];
  return true;
}

/// A part of the map between lines, within the outlines.
struct MapPart {
  int owner = -1;  ///< the compartment of most columns.
  int n_columns = 0;
  Vector2d inside = {0, 0};
  double away = 0;  ///< m, of `inside` from all lines.
};

std::vector<MapPart> parts_with(const std::vector<PlacedColumn>& columns, const ModelLines& lines) {
  std::map<int, MapPart> parts;
  std::map<int, std::map<int, int>> n_of;  // per part and compartment
  for (const PlacedColumn& column : columns) {
    MapPart& part = parts[column.part];
    part.n_columns += 1;
    for (const int c : column.compartments) n_of[column.part][c] += 1;
    const double away = distance_to_lines(lines, column.middle);
    if (away <= part.away) continue;
    part.away = away;
    part.inside = column.middle;
  }
  std::vector<MapPart> all;
  for (auto& [number, part] : parts) {
    part.owner = std::ranges::max_element(n_of[number], {}, [](const auto& one) {
                   return one.second;
                 })->first;
    all.push_back(part);
  }
  return all;
}

bool has_room(const MapPart& part, const ModelLines& lines) {
  return part.away > 0.5 * lines.strike;
}

std::vector<ModelCompartment> named_parts(const GridStructure& structure, const ModelLines& lines,
                                          std::vector<MapPart> parts) {
  std::ranges::stable_sort(parts, std::greater(), &MapPart::n_columns);
  std::vector<ModelCompartment> named;
  for (int c = 0; c < static_cast<int>(structure.compartments.size()); ++c) {
    std::vector<Vector2d> inside;
    for (const MapPart& part : parts) {
      if (part.owner == c && has_room(part, lines)) inside.push_back(part.inside);
    }
    if (inside.empty()) continue;
    named.push_back({concat("C", structure.compartments[c].region), c, inside.front(),
                     std::vector<Vector2d>(inside.begin() + 1, inside.end())});
  }
  return named;
}

/// What became of the compartments of the grid that the model has none of.
void say_joined(const GridStructure& structure, const ModelLines& lines,
                const std::vector<PlacedColumn>& columns,
                const std::vector<ModelCompartment>& named, Remarks& remarks) {
  for (int c = 0; c < static_cast<int>(structure.compartments.size()); ++c) {
    if (contains(named, c, &ModelCompartment::source)) continue;
    const bool is_wide = std::ranges::any_of(columns, [&](const PlacedColumn& column) {
      return contains(column.compartments, c) &&
             distance_to_lines(lines, column.middle) > 0.5 * lines.strike;
    });
    const std::string number = number_of(structure, c);
    if (is_wide)
      remarks.push_back({RemarkKind::left_out,
                         number + " is part of another one in the model, as no line separates them",
                         "--extend-faults, /geometry/dividers"});
    else
      remarks.push_back({RemarkKind::left_out,
                         number + " is too narrow for cells of the model: its pressures count "
                                  "where they overlap others",
                         "--strike"});
  }
}

void say_parts(const GridStructure& structure, const ModelLines& lines,
               const std::vector<MapPart>& parts, const std::vector<ModelCompartment>& named,
               Remarks& remarks) {
  for (const ModelCompartment& one : named) {
    if (one.also.empty()) continue;
    remarks.push_back({RemarkKind::choice,
                       concat(number_of(structure, one.source), " is in ", 1 + one.also.size(),
                              " parts between lines of the model: one compartment all the same"),
                       "/geometry/compartments, \"also_inside\""});
  }
  int n_lost = 0, n_all = 0;
  for (const MapPart& part : parts) {
    n_all += part.n_columns;
    if (!has_room(part, lines)) n_lost += part.n_columns;
  }
  if (n_lost == 0) return;
  remarks.push_back({RemarkKind::warning,
                     concat("no compartment of the model has ", n_lost, " of ",
                            counted(n_all, "column", "columns"),
                            " within the outline: lines leave less than half a cell of the mesh "
                            "beside them"),
                     "--strike, /geometry/compartments"});
}

}  // namespace

std::vector<ModelCompartment> model_compartments(const CornerPointGrid& grid,
                                                 const GridStructure& structure,
                                                 const ModelLines& lines, Remarks& remarks) {
  std::vector<PlacedColumn> columns = placed_columns(grid, structure, lines);
  if (!find_parts(lines, columns)) {
    // Nothing can be meshed yet: one part for the first compartment of each column, to be changed.
    for (PlacedColumn& column : columns) column.part = column.compartments.front();
  }
  const std::vector<MapPart> parts = parts_with(columns, lines);
  std::vector<ModelCompartment> named = named_parts(structure, lines, parts);
  say_joined(structure, lines, columns, named, remarks);
  say_parts(structure, lines, parts, named, remarks);
  return named;
}

}  // namespace faultsim::grid_scene
