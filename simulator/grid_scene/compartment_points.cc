#include "simulator/grid_scene/compartment_points.h"

#include <algorithm>
#include <set>

#include "simulator/common/errors.h"
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

/// Leaves out those that no line parts from one before.
void join_parts(const GridStructure& structure, const ModelLines& lines,
                std::vector<ModelCompartment>& found, Remarks& remarks) {
  const horizons::LayeredBody body = body_of_lines(lines);
  std::vector<Problem> problems;
  const horizons::MapLines met = horizons::meeting_lines(body, problems);
  if (!problems.empty()) return;
  const horizons::MapMesh map = horizons::mesh_map(body, met, problems);
  if (!problems.empty()) return;
  std::vector<horizons::Compartment> named;
  for (const ModelCompartment& one : found) named.push_back({one.name, one.inside, {}});
  horizons::fill_compartments(map, named, problems);
  for (std::size_t c = found.size(); c-- > 0;) {
    const std::string pointer = concat("/compartments/", c, "/inside");
    const auto problem = std::ranges::find(problems, pointer, &Problem::pointer);
    if (problem == problems.end()) continue;
    remarks.push_back({RemarkKind::left_out,
                       number_of(structure, found[c].source) +
                           " is part of another one in the model, as no line separates them",
                       "--extend-faults, /geometry/dividers"});
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(c));
  }
}

}  // namespace

std::vector<ModelCompartment> model_compartments(const CornerPointGrid& grid,
                                                 const GridStructure& structure,
                                                 const ModelLines& lines, Remarks& remarks) {
  std::vector<ModelCompartment> found;
  for (int c = 0; c < static_cast<int>(structure.compartments.size()); ++c) {
    std::set<int> columns;
    for (const int cell : structure.compartments[c].cells) columns.insert(cell % grid.n_columns());
    ModelCompartment one{concat("C", structure.compartments[c].region), c};
    double most = 0;
    for (const int column : columns) {
      const Vector2d at = middle_of(grid, column, lines.reference_z);
      if (!is_within(lines.outlines, at)) continue;
      const double away = distance_to_lines(lines, at);
      if (away <= most) continue;
      most = away;
      one.inside = at;
    }
    if (most > 0.5 * lines.strike) {
      found.push_back(one);
    } else {
      remarks.push_back({RemarkKind::left_out,
                         number_of(structure, c) + " is too narrow for cells of the model: its "
                                                   "pressures count where they overlap others",
                         "--strike"});
    }
  }
  join_parts(structure, lines, found, remarks);
  return found;
}

}  // namespace faultsim::grid_scene
