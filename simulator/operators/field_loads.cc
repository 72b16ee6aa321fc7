#include "simulator/operators/field_loads.h"

#include "simulator/common/errors.h"
#include "simulator/flow/report_choice.h"
#include "simulator/loads/history.h"

namespace faultsim {
namespace {

void refuse_what_cannot_be(const Plan& plan, const FlowField& field, const FieldChoice& choice) {
  std::vector<Problem> problems;
  if (plan.half_domain) {
    problems.push_back({"/numerics/half_domain", 0,
                        "a pressure field need not be symmetric, and half of the scene is modelled",
                        "model all of it: --set /numerics/half_domain=off"});
  }
  if (choice.reference < 0 || choice.reference >= std::ssize(field.date)) {
    problems.push_back({"", 0, concat("the flow result has no report ", choice.reference),
                        concat("choose among 0 to ", std::ssize(field.date) - 1)});
  }
  if (!problems.empty()) throw InputError("scene", problems);
}

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
    const bool from_cells =
        law.rule != FaultPressureRule::none && law.rule != FaultPressureRule::prescribed;
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

/// Columns of a matrix from reports' numbers.
Eigen::MatrixXd columns(const Eigen::MatrixXd& all, const std::vector<int>& kept) {
  Eigen::MatrixXd some(all.rows(), std::ssize(kept));
  for (Eigen::Index k = 0; k < some.cols(); ++k) some.col(k) = all.col(kept[k]);
  return some;
}

}  // namespace

FieldLoads field_loads(const Scene& scene, const Plan& plan, const PreparedInfluence& prepared,
                       const FlowField& field, const FieldChoice& choice, int n_threads) {
  refuse_what_cannot_be(plan, field, choice);
  const InfluenceBlock& block = *prepared.block;
  const Mesh mesh = bulk_problem(scene, plan).mesh;
  FieldLoads loads;
  loads.mapping = map_flow(field, mapped_cells(mesh, block), block.region_names, choice.outside);
  const Eigen::Index n_reports = std::ssize(field.date) - choice.reference;
  Eigen::MatrixXd stress =
      mapped_change(loads.mapping, field, choice.reference).rightCols(n_reports);
  Eigen::MatrixXd change = Eigen::MatrixXd::Zero(std::ssize(mesh.cells), n_reports);
  for (std::size_t c = 0; c < block.cells.size(); ++c) {
    const InfluenceCell& cell = block.cells[c];
    auto row = stress.row(static_cast<Eigen::Index>(c));
    row *= cell.fraction;
    change.row(cell.cell) = row;
    row *= scene.materials[cell.material].biot;
  }
  const Eigen::MatrixXd locked = locked_change(block, stress, n_threads);
  const Eigen::MatrixXd pressure = fault_pressures(scene, mesh, prepared.op->geometry, change);
  std::vector<double> time;
  for (Eigen::Index t = 0; t < n_reports; ++t)
    time.push_back(field.date[choice.reference + t] - field.date[choice.reference]);
  Eigen::MatrixXd both(locked.rows() + pressure.rows(), n_reports);
  both << locked, pressure;
  const std::vector<int> kept = needed_reports(time, both, choice.bound);
  loads.history.locked = columns(locked, kept);
  loads.history.fault_pressure = columns(pressure, kept);
  for (const int t : kept) {
    loads.history.time.push_back(time[t]);
    loads.reports.push_back(choice.reference + t);
  }
  return loads;
}

}  // namespace faultsim
