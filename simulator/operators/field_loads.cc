#include "simulator/operators/field_loads.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/loads/history.h"
#include "simulator/scene/initial_state.h"
#include "simulator/scene/read_scene.h"

namespace faultsim {
namespace {

std::vector<MappedCell> mapped_cells(const Mesh& mesh, const InfluenceBlock& block) {
  std::vector<MappedCell> cells;
  for (const InfluenceCell& cell : block.cells) {
    MappedCell mapped{.corners = {}, .region = cell.region, .fraction = cell.fraction};
    for (std::size_t i = 0; i < 8; ++i) mapped.corners[i] = mesh.nodes[mesh.cells[cell.cell][i]];
    cells.push_back(mapped);
  }
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
        const int node = geometry.faults[f].node_of_point[point];
        if (node < 0) continue;
        area[node] += face.area / 4;
        for (Eigen::Index t = 0; from_cells && t < change.cols(); ++t) {
          sum(node, t) +=
              face.area / 4 *
              pressure_by_rule(law, change(face.minus_cell, t), change(face.plus_cell, t));
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

std::vector<std::string> coverage_warnings(const FieldLoads& loads, OutsideRule rule) {
  constexpr double kWhole = 1 - 1e-6;
  std::vector<std::string> warnings;
  for (std::size_t r = 0; r < loads.region_names.size(); ++r) {
    const RegionCoverage& region = loads.mapping.coverage[r];
    if (region.covered >= kWhole * region.volume) continue;
    warnings.push_back(concat("the pressure field does not cover all of ", loads.region_names[r],
                              ": ", coverage_text(region, rule)));
  }
  return warnings;
}

/// Where the pressures of the reference report are not those that the initial state has.
std::vector<std::string> reference_warnings(const Scene& scene, const InfluenceBlock& block,
                                            const FlowMapping& mapping) {
  constexpr double kAgrees = 5e5;  // Pa
  const Eigen::VectorXd pressure = mapped_values(mapping, *scene.flow.field, scene.flow.reference);
  Eigen::MatrixXd excess = Eigen::MatrixXd::Zero(pressure.size(), 1);
  for (Eigen::Index c = 0; c < pressure.size(); ++c) {
    const InfluenceCell& cell = block.cells[static_cast<std::size_t>(c)];
    const double depth = -cell.centroid.z();
    const bool is_mapped = !mapping.weights[static_cast<std::size_t>(c)].empty();
    const auto region = static_cast<std::size_t>(cell.region);
    if (is_mapped) excess(c, 0) = pressure[c] - initial_region_pressure(scene, region, depth);
  }
  const Eigen::MatrixXd mean = region_means(block, excess);
  std::vector<std::string> warnings;
  for (Eigen::Index r = 0; r < mean.rows(); ++r) {
    if (std::abs(mean(r, 0)) <= kAgrees) continue;
    warnings.push_back(concat(
        "the pressure field begins ", std::lround(std::abs(mean(r, 0)) / 1e5), " bar ",
        mean(r, 0) > 0 ? "above" : "below", " the initial pressure of ",
        block.region_names[static_cast<std::size_t>(r)],
        " (mean over its volume): the change since its reference acts on the scene's initial state; "
        "give the initial state the same pressure, as overpressure of the block"));
  }
  return warnings;
}

}  // namespace

FieldLoads field_loads(const Scene& scene, const Plan& plan, const PreparedInfluence& prepared,
                       int n_threads) {
  FAULTSIM_DEMAND(scene.flow.is_given() && !plan.half_domain, "a field on all of the domain");
  const InfluenceBlock& block = *prepared.block;
  const FlowLoad& flow = scene.flow;
  const Mesh mesh = bulk_problem(scene, plan).mesh;
  FieldLoads loads;
  loads.region_names = block.region_names;
  loads.mapping =
      map_flow(*flow.field, mapped_cells(mesh, block), block.region_names, flow.outside);
  Eigen::MatrixXd stress = mapped_change(loads.mapping, *flow.field, flow.reference, flow.reports);
  FieldHistory& history = loads.history;
  history.time = flow.time;
  history.region_change = region_means(block, stress);
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(std::ssize(mesh.cells), stress.cols());
  for (std::size_t c = 0; c < block.cells.size(); ++c) {
    const InfluenceCell& cell = block.cells[c];
    auto row = stress.row(static_cast<Eigen::Index>(c));
    row *= cell.fraction;
    change.row(cell.cell) = row;
    row *= scene.materials[cell.material].biot;
  }
  history.locked = locked_change(block, stress, n_threads);
  history.observed = block.observed * stress;
  history.fault_pressure = fault_pressures(scene, mesh, prepared.op->geometry, change);
  loads.warnings = coverage_warnings(loads, flow.outside);
  for (std::string& warning : reference_warnings(scene, block, loads.mapping))
    loads.warnings.push_back(std::move(warning));
  return loads;
}

std::string field_loads_key(const Scene& scene) {
  std::string key = canonical_parts(scene).pressure_field;
  for (const Material& material : scene.materials) key += concat(" ", material.biot);
  for (const Fault& fault : scene.faults)
    key += concat(" ", static_cast<int>(fault.pressure.rule), " ", fault.pressure.fraction);
  return fingerprint(key);
}

}  // namespace faultsim
