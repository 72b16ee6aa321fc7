#include "simulator/operators/mapped_load.h"

#include "simulator/plan/field_bodies.h"

namespace faultsim {

MappedLoad map_load(const FlowLoad& load, const Mesh& mesh, const std::vector<CellOfRegion>& cells,
                    const std::vector<std::string>& region_names, bool half_domain) {
  std::vector<MappedCell> bodies;
  for (const CellOfRegion& cell : cells) {
    MappedCell body{.corners = corners_of_cell(mesh, cell.cell),
                    .region = cell.region,
                    .fraction = cell.fraction};
    if (mesh.plane_strain) body.corners = at_section(body.corners, load.y);
    bodies.push_back(body);
  }
  MappingRules rules{.outside = load.outside, .integral = load.integral};
  if (mesh.plane_strain) rules.y_range = {load.y - kHalfSection, load.y + kHalfSection};
  if (half_domain) rules.y_range[0] = 0;
  const std::shared_ptr<const FlowField> field = field_in_scene(load);
  MappedLoad mapped{.mapping = map_flow(*field, bodies, region_names, rules)};
  mapped.change = mapped_change(mapped.mapping, *field, load.reference, load.reports);
  mapped.means = mapped.change.rightCols(1);
  if (load.integral == IntegralRule::flow_grid)
    mapped.balance = keep_integrals(mapped.mapping, *field, load.reference, load.reports,
                                    region_names, mapped.change);
  return mapped;
}

}  // namespace faultsim
