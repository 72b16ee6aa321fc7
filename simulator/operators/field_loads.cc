#include "simulator/operators/field_loads.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/condensation/fault_geometry.h"
#include "simulator/loads/history.h"
#include "simulator/operators/mapped_load.h"
#include "simulator/scene/identity.h"

namespace faultsim {
namespace {

std::vector<CellOfRegion> cells_of(const InfluenceBlock& block) {
  std::vector<CellOfRegion> cells;
  for (const InfluenceCell& cell : block.cells)
    cells.push_back({cell.cell, cell.region, cell.fraction});
  return cells;
}

/// Δp_f of every node and report (n_nodes x n_reports).
/// @param change  f_c Δp_c of all cells of the mesh, Pa (n_cells x n_reports).
Eigen::MatrixXd fault_pressures(const Scene& scene, const Mesh& mesh, const FaultGeometry& geometry,
                                const Eigen::MatrixXd& change) {
  const Eigen::Index n_nodes = std::ssize(geometry.nodes);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n_nodes, change.cols());
  Eigen::VectorXd area = Eigen::VectorXd::Zero(n_nodes);
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const FaultPressure& law = scene.faults[f].pressure;
    const bool from_cells = law.rule != FaultPressureRule::none &&
                            law.rule != FaultPressureRule::prescribed &&
                            law.rule != FaultPressureRule::table;
    for (const FaultFace& face : mesh.faults[f].faces) {
      for (const int point : face.points) {
        const int node = point < 0 ? -1 : geometry.faults[f].node_of_point[point];
        if (node < 0) continue;
        area[node] += corner_area(face);
        for (Eigen::Index t = 0; from_cells && t < change.cols(); ++t) {
          sum(node, t) += corner_area(face) * pressure_by_rule(law, change(face.minus_cell, t),
                                                               change(face.plus_cell, t));
        }
      }
    }
  }
  for (Eigen::Index k = 0; k < n_nodes; ++k) sum.row(k) /= area[k];
  return sum;
}

/// Mean over each region's volume of a value per cell (n_regions x n_columns).
Eigen::MatrixXd region_means(const InfluenceBlock& block, const Eigen::MatrixXd& value) {
  const Eigen::Index n_regions = std::ssize(block.region_names);
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(n_regions, value.cols());
  Eigen::VectorXd volume = Eigen::VectorXd::Zero(n_regions);
  for (std::size_t c = 0; c < block.cells.size(); ++c) {
    const InfluenceCell& cell = block.cells[c];
    const double part = cell.fraction * cell.volume;
    mean.row(cell.region) += part * value.row(static_cast<Eigen::Index>(c));
    volume[cell.region] += part;
  }
  for (Eigen::Index r = 0; r < n_regions; ++r) {
    if (volume[r] > 0) mean.row(r) /= volume[r];
  }
  return mean;
}

/// FieldHistory::beside_minus or beside_plus.
/// @param cell_of  that side's cell of a face.
/// @param regions  per node, of that side; -1 = none.
/// @param change  Δp of the block's cells, Pa (n_cells x n_reports).
/// @param mean  of each region.
Eigen::MatrixXd beside(const Mesh& mesh, const FaultGeometry& geometry, const InfluenceBlock& block,
                       int FaultFace::*cell_of, const std::vector<int>& regions,
                       const Eigen::MatrixXd& change, const Eigen::MatrixXd& mean) {
  std::vector<int> row_of(mesh.cells.size(), -1);
  for (std::size_t c = 0; c < block.cells.size(); ++c)
    row_of[block.cells[c].cell] = static_cast<int>(c);
  const Eigen::Index n_nodes = std::ssize(geometry.nodes);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n_nodes, change.cols());
  Eigen::VectorXd area = Eigen::VectorXd::Zero(n_nodes);
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    for (const FaultFace& face : mesh.faults[f].faces) {
      const int row = row_of[face.*cell_of];
      for (const int point : face.points) {
        const int node = point < 0 ? -1 : geometry.faults[f].node_of_point[point];
        if (node < 0 || row < 0 || block.cells[row].region != regions[node]) continue;
        const double part = corner_area(face) * block.cells[row].fraction;
        area[node] += part;
        sum.row(node) += part * (change.row(row) - mean.row(regions[node]));
      }
    }
  }
  for (Eigen::Index k = 0; k < n_nodes; ++k)
    if (area[k] > 0) sum.row(k) /= area[k];
  return sum;
}

/// Both sides of FieldHistory::beside_*.
void set_beside(const Scene& scene, const Mesh& mesh, const FaultOperator& op,
                const InfluenceBlock& block, const Eigen::MatrixXd& change, FieldHistory& history) {
  const FaultGeometry& geometry = op.geometry;
  std::vector<int> minus, plus;
  for (const SideRegions& one : side_regions(geometry, LoadFactors(scene, op).region_of_load())) {
    minus.push_back(one.minus);
    plus.push_back(one.plus);
  }
  history.beside_minus =
      beside(mesh, geometry, block, &FaultFace::minus_cell, minus, change, history.region_change);
  history.beside_plus =
      beside(mesh, geometry, block, &FaultFace::plus_cell, plus, change, history.region_change);
}

/// A field in the block's cells.
struct MappedField {
  const FlowLoad& load;
  std::string quantity;  ///< "pressure".
  std::string name = quantity + " field";
  MappedLoad mapped = {};  ///< in the block's cells.
};

MappedField map_field(const FlowLoad& load, const std::string& quantity, const FieldCells& cells) {
  MappedField field{.load = load, .quantity = quantity};
  if (load.is_given())
    field.mapped = map_load(load, cells.mesh, cells_of(cells.block), cells.block.region_names,
                            cells.op.geometry.half_domain);
  return field;
}

/// The times of all reports.
std::vector<double> all_times(const MappedField& one, const MappedField& other) {
  std::vector<double> all;
  std::set_union(one.load.time.begin(), one.load.time.end(), other.load.time.begin(),
                 other.load.time.end(), std::back_inserter(all));
  return all;
}

/// The changes at all times, 0 of a field that is not there.
Eigen::MatrixXd change_at(const MappedField& field, const std::vector<double>& times,
                          Eigen::Index n_cells) {
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n_cells, std::ssize(times));
  for (Eigen::Index t = 0; field.load.is_given() && t < change.cols(); ++t)
    change.col(t) = at_time(field.load.time, field.mapped.change, times[t]);
  return change;
}

/// Of every compartment; none of a field that is not there.
std::vector<FieldIntegral> integrals_of(const MappedField& field, const InfluenceBlock& block) {
  std::vector<FieldIntegral> integrals;
  const auto& [mapping, change, means, balance] = field.mapped;
  for (std::size_t r = 0; field.load.is_given() && r < block.region_names.size(); ++r) {
    const RegionCoverage& region = mapping.coverage[r];
    FieldIntegral& one = integrals.emplace_back();
    one.field = field.quantity;
    one.region = block.region_names[r];
    one.n_cells = region.n_cells;
    one.n_outside = region.n_outside;
    one.n_partly = region.n_partly;
    one.takes_nearest = field.load.outside == OutsideRule::nearest;
    if (balance.empty()) continue;
    double flow_volume = 0;
    for (const FlowMapping::Weight& own : mapping.flow_cells[r]) flow_volume += own.value;
    one.whole = {.flow_grid = balance[r].flow_grid,
                 .mapped = balance[r].mapped,
                 .largest_scaling = balance[r].largest_scaling,
                 .flow_volume = flow_volume};
  }
  for (std::size_t c = 0; field.load.is_given() && c < block.cells.size(); ++c) {
    const InfluenceCell& cell = block.cells[c];
    FieldIntegral& one = integrals[static_cast<std::size_t>(cell.region)];
    const double part = cell.volume * cell.fraction, covered = mapping.covered[c] * part;
    const double last = change(static_cast<Eigen::Index>(c), change.cols() - 1);
    one.volume += part;
    one.covered += covered;
    one.acts += part * last;
    one.has += covered * means[static_cast<Eigen::Index>(c)];
    one.size += part * std::abs(last);
    one.assumed += (part - covered) * std::abs(last);
  }
  return integrals;
}

/// Locked tractions, observations and forces of stresses in the cells.
/// @param stress  s_c, Pa, n_cells x n_reports.
void condense(const FieldCells& cells, Eigen::MatrixXd stress, int n_threads,
              FieldHistory& history) {
  if (cells.bulk != nullptr) {
    std::vector numbers = mapped(cells.block.cells, &InfluenceCell::cell);
    history.cell_forces = cells.bulk->bulk(0).dilatations(numbers);
  }
  const Eigen::MatrixXd& of = cells.bulk != nullptr ? (history.stress = std::move(stress)) : stress;
  // A block without faults has no rows; one without influences has no columns either.
  if (cells.block.traction.view().cols() > 0) {
    history.locked = locked_change(cells.block, of, n_threads);
    history.observed = cells.block.observed * of;
    return;
  }
  if (cells.bulk == nullptr) return;
  history.locked.resize(cells.op.geometry.n_dofs, of.cols());
  for (Eigen::Index t = 0; t < of.cols(); ++t) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(cells.op.n_unknowns);
    history.add_forces(history.time[t], force);
    CondensedBulk& bulk = cells.bulk->bulk(0);
    history.locked.col(t) = bulk.locked_traction(bulk.forward(force));
  }
}

/// Share of the volume of all compartments; 1 of a field that is not there.
double covered_share(const FlowMapping& mapping) {
  double covered = 0, volume = 0;
  for (const RegionCoverage& region : mapping.coverage) {
    covered += region.covered;
    volume += region.volume;
  }
  return volume > 0 ? std::min(covered / volume, 1.0) : 1;
}

/// What became of the cells of each compartment that has some.
void report_coverage(const MappedField& field, const InfluenceBlock& block, FieldLoads& loads) {
  if (!field.load.is_given()) return;
  for (const std::string& note : field.load.field->notes)
    loads.notes.push_back(concat(field.name, " ", note));
  const std::vector<FieldIntegral> integrals = integrals_of(field, block);
  for (std::size_t r = 0; r < integrals.size(); ++r) {
    const RegionCoverage& region = field.mapped.mapping.coverage[r];
    if (region.n_cells == 0) continue;
    std::string text = concat(field.name, " on ", block.region_names[r], ": ",
                              coverage_text(region, field.load.outside));
    if (!integrals[r].is_whole() && !integrals[r].whole) {
      text += formatted(
          "; of the integral of its change at the last report %.4g %% lies in what is covered",
          100 * (1 - integrals[r].assumed_share()));
    }
    loads.notes.push_back(text);
    loads.integrals.push_back(integrals[r]);
  }
}

}  // namespace

FieldLoads field_loads(const Scene& scene, const FieldCells& cells, int n_threads) {
  FAULTSIM_DEMAND(scene.has_field(), "loads of a field");
  const Mesh& mesh = cells.mesh;
  const InfluenceBlock& block = cells.block;
  const MappedField pressure = map_field(scene.pressure_field, "pressure", cells);
  const MappedField temperature = map_field(scene.temperature_field, "temperature", cells);
  const Eigen::Index n_cells = std::ssize(block.cells);
  FieldHistory history;
  history.time = all_times(pressure, temperature);
  Eigen::MatrixXd stress = change_at(pressure, history.time, n_cells);
  const Eigen::MatrixXd heating = change_at(temperature, history.time, n_cells);
  history.region_change = region_means(block, stress);
  if (scene.temperature_field.is_given()) history.region_heating = region_means(block, heating);
  set_beside(scene, mesh, cells.op, block, stress, history);
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(std::ssize(mesh.cells), stress.cols());
  for (std::size_t c = 0; c < block.cells.size(); ++c) {
    const InfluenceCell& cell = block.cells[c];
    const Material& material = scene.materials[cell.material];
    const auto row = static_cast<Eigen::Index>(c);
    change.row(cell.cell) = cell.fraction * stress.row(row);
    stress.row(row) = material.biot * change.row(cell.cell) +
                      thermal_stress(material) * cell.fraction * heating.row(row);
  }
  history.fault_pressure = fault_pressures(scene, mesh, cells.op.geometry, change);
  condense(cells, std::move(stress), n_threads, history);
  FieldLoads loads;
  for (const MappedField* field : {&pressure, &temperature}) report_coverage(*field, block, loads);
  if (scene.pressure_field.is_given())
    loads.notes.push_back(
        "pressures of compartments at a load step are means over their volumes; those where a "
        "fault begins to slide or jumps are of the field's cells beside the place");
  loads.coverage =
      std::min(covered_share(pressure.mapped.mapping), covered_share(temperature.mapped.mapping));
  loads.mapping = pressure.mapped.mapping;
  loads.history = std::make_shared<const FieldHistory>(std::move(history));
  return loads;
}

std::string field_loads_key(const Scene& scene) {
  std::string key = canonical_parts(scene).fields;
  for (const Material& material : scene.materials)
    key += concat(" ", material.biot, " ", material.thermal_expansion);
  for (const Fault& fault : scene.faults)
    key += concat(" ", static_cast<int>(fault.pressure.rule), " ", fault.pressure.fraction);
  return fingerprint(key);
}

}  // namespace faultsim
