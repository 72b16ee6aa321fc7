#include "simulator/cache/operator_tables.h"

#include <cstddef>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

void push(std::vector<double>& table, const Eigen::Vector3d& row) {
  table.insert(table.end(), row.data(), row.data() + 3);
}

Eigen::Vector3d row3(const std::vector<double>& table, std::size_t row) {
  return {table[3 * row], table[3 * row + 1], table[3 * row + 2]};
}

template <typename Dense>
std::vector<double> flat(const Dense& dense) {
  return {dense.data(), dense.data() + dense.size()};
}

void demand(bool holds, const char* what) {
  if (!holds) throw StorageError(concat("the tables of an operator disagree: ", what));
}

/// Hands out consecutive stretches of a list; runs out with a StorageError.
template <typename Value>
class Cursor {
 public:
  Cursor(const std::vector<Value>& values, int columns) : values_(values), columns_(columns) {}
  const Value* take(int n_rows) {
    const std::size_t n = static_cast<std::size_t>(n_rows) * static_cast<std::size_t>(columns_);
    demand(n_rows >= 0 && at_ + n <= values_.size(), "a list ends early");
    at_ += n;
    return values_.data() + (at_ - n);
  }
  bool at_end() const { return at_ == values_.size(); }

 private:
  const std::vector<Value>& values_;
  int columns_;
  std::size_t at_ = 0;
};

void add_node(OperatorTables& t, const OperatorNode& node) {
  push(t.node_position, node.position);
  push(t.node_normal, node.normal);
  push(t.node_strike, node.strike);
  push(t.node_dip, node.dip);
  t.node_numbers.insert(t.node_numbers.end(),
                        {node.area, node.effective_shear_modulus, node.poisson_ratio,
                         node.edge_strike, node.edge_dip});
  t.node_dof.insert(t.node_dof.end(), node.dof.begin(), node.dof.end());
  t.node_n_pairs.push_back(static_cast<int>(node.pressure.size()));
  for (const PressurePair& pair : node.pressure) {
    t.pair_regions.insert(t.pair_regions.end(), {pair.minus_region, pair.plus_region});
    t.pair_numbers.insert(t.pair_numbers.end(),
                          {pair.minus_fraction, pair.plus_fraction, pair.weight});
  }
}

void add_fault(OperatorTables& t, const OperatorFault& fault) {
  FAULTSIM_DEMAND(fault.node_of_point.size() == fault.points.size(), "fault ", fault.name, " has ",
                  fault.points.size(), " points");
  t.fault_names.push_back(fault.name);
  t.fault_numbers.insert(t.fault_numbers.end(),
                         {fault.first_node, fault.n_nodes, static_cast<int>(fault.points.size()),
                          static_cast<int>(fault.faces.size())});
  for (const auto& point : fault.points) push(t.points, point);
  t.node_of_point.insert(t.node_of_point.end(), fault.node_of_point.begin(),
                         fault.node_of_point.end());
  for (const auto& face : fault.faces) t.faces.insert(t.faces.end(), face.begin(), face.end());
}

std::vector<OperatorNode> read_nodes(const OperatorTables& t, int n_dofs) {
  const std::size_t n_nodes = t.node_n_pairs.size();
  for (const auto* table : {&t.node_position, &t.node_normal, &t.node_strike, &t.node_dip}) {
    demand(table->size() == 3 * n_nodes, "nodes and their directions");
  }
  demand(t.node_numbers.size() == 5 * n_nodes && t.node_dof.size() == 3 * n_nodes, "nodes");
  Cursor regions(t.pair_regions, 2);
  Cursor numbers(t.pair_numbers, 3);
  std::vector<OperatorNode> nodes(n_nodes);
  for (std::size_t i = 0; i < n_nodes; ++i) {
    OperatorNode& node = nodes[i];
    node.position = row3(t.node_position, i);
    node.normal = row3(t.node_normal, i);
    node.strike = row3(t.node_strike, i);
    node.dip = row3(t.node_dip, i);
    const double* number = &t.node_numbers[5 * i];
    node.area = number[0];
    node.effective_shear_modulus = number[1];
    node.poisson_ratio = number[2];
    node.edge_strike = number[3];
    node.edge_dip = number[4];
    for (std::size_t c = 0; c < 3; ++c) {
      node.dof[c] = t.node_dof[3 * i + c];
      demand(node.dof[c] >= -1 && node.dof[c] < n_dofs, "dof of a node");
    }
    const int* region = regions.take(t.node_n_pairs[i]);
    const double* pair = numbers.take(t.node_n_pairs[i]);
    for (int k = 0; k < t.node_n_pairs[i]; ++k, region += 2, pair += 3) {
      node.pressure.push_back({region[0], pair[0], region[1], pair[1], pair[2]});
    }
  }
  demand(regions.at_end() && numbers.at_end(), "pressure pairs");
  return nodes;
}

void check_indices(const OperatorFault& fault, int n_nodes) {
  const int n_points = static_cast<int>(fault.points.size());
  demand(fault.first_node >= 0 && fault.n_nodes >= 0 && fault.first_node <= n_nodes - fault.n_nodes,
         "nodes of a fault");
  for (const int node : fault.node_of_point)
    demand(node >= -1 && node < n_nodes, "node of a point");
  for (const auto& face : fault.faces) {
    for (const int point : face) demand(point >= 0 && point < n_points, "corner of a face");
  }
}

std::vector<OperatorFault> read_faults(const OperatorTables& t,
                                       const std::vector<OperatorNode>& nodes) {
  demand(t.fault_numbers.size() == 4 * t.fault_names.size(), "faults");
  Cursor points(t.points, 3);
  Cursor nodes_of_points(t.node_of_point, 1), corners(t.faces, 4);
  std::vector<OperatorFault> faults(t.fault_names.size());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    OperatorFault& fault = faults[i];
    const int* number = &t.fault_numbers[4 * i];
    fault.name = t.fault_names[i];
    fault.first_node = number[0];
    fault.n_nodes = number[1];
    const double* point = points.take(number[2]);
    const int* node = nodes_of_points.take(number[2]);
    for (int k = 0; k < number[2]; ++k, point += 3) {
      fault.points.emplace_back(point[0], point[1], point[2]);
      fault.node_of_point.push_back(node[k]);
    }
    const int* corner = corners.take(number[3]);
    for (int k = 0; k < number[3]; ++k, corner += 4) {
      fault.faces.push_back({corner[0], corner[1], corner[2], corner[3]});
    }
    check_indices(fault, static_cast<int>(nodes.size()));
    fault.profiles = fault_profiles(fault, nodes);
  }
  demand(points.at_end() && nodes_of_points.at_end() && corners.at_end(),
         "points and faces of the faults");
  return faults;
}

Eigen::MatrixXd read_matrix(const std::vector<double>& values, Eigen::Index n_rows,
                            Eigen::Index n_columns, const char* what) {
  demand(static_cast<Eigen::Index>(values.size()) == n_rows * n_columns, what);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), n_rows, n_columns);
}

}  // namespace

OperatorTables to_tables(const FaultOperator& op) {
  const FaultGeometry& geometry = op.geometry;
  OperatorTables t;
  t.fingerprint = {op.fingerprint};
  t.blas = {op.blas};
  t.header = {geometry.n_dofs, geometry.plane_strain ? 1 : 0, geometry.half_domain ? 1 : 0,
              op.n_unknowns};
  t.provenance = {op.build_seconds, op.factor_bytes};
  for (const OperatorNode& node : geometry.nodes) add_node(t, node);
  for (const OperatorFault& fault : geometry.faults) add_fault(t, fault);
  for (const auto& position : geometry.locked_positions) push(t.locked_positions, position);
  t.dof_area = flat(op.geometry.dof_area);
  for (const LoadKey& key : op.loads.keys) {
    t.load_keys.insert(t.load_keys.end(), {static_cast<int>(key.kind), key.index, key.material});
  }
  t.locked = flat(op.loads.traction);
  for (const ObservationRow& row : op.observed.rows) {
    t.observation_names.push_back(row.name);
    push(t.observation_position, row.position);
  }
  t.observed_load = flat(op.observed.per_load);
  t.observed_jump = flat(op.observed.per_jump);
  return t;
}

FaultOperator from_tables(const OperatorTables& t) {
  demand(t.header.size() == 4 && t.provenance.size() == 2 && t.fingerprint.size() == 1 &&
             t.blas.size() == 1 && t.header[0] >= 0,
         "header");
  FaultOperator op;
  op.fingerprint = t.fingerprint[0];
  op.blas = t.blas[0];
  op.n_unknowns = t.header[3];
  op.build_seconds = t.provenance[0];
  op.factor_bytes = t.provenance[1];
  op.geometry.n_dofs = t.header[0];
  op.geometry.plane_strain = t.header[1] != 0;
  op.geometry.half_domain = t.header[2] != 0;
  op.geometry.nodes = read_nodes(t, op.geometry.n_dofs);
  op.geometry.faults = read_faults(t, op.geometry.nodes);
  demand(t.locked_positions.size() % 3 == 0, "locked positions");
  for (std::size_t i = 0; i < t.locked_positions.size() / 3; ++i) {
    op.geometry.locked_positions.push_back(row3(t.locked_positions, i));
  }
  demand(t.observation_position.size() == 3 * t.observation_names.size(), "observations");
  for (std::size_t i = 0; i < t.observation_names.size(); ++i) {
    op.observed.rows.push_back({t.observation_names[i], row3(t.observation_position, i)});
  }
  demand(t.load_keys.size() % 3 == 0, "keys of the loads");
  for (std::size_t k = 0; k < t.load_keys.size(); k += 3) {
    const int kind = t.load_keys[k];
    demand(kind == 0 || kind == 1, "kind of a load");
    op.loads.keys.push_back(
        {static_cast<LoadKey::Kind>(kind), t.load_keys[k + 1], t.load_keys[k + 2]});
  }
  const auto n_loads = static_cast<Eigen::Index>(op.loads.keys.size());
  const auto n_observed = static_cast<Eigen::Index>(op.observed.rows.size());
  const Eigen::Index n_dofs = op.geometry.n_dofs;
  op.geometry.dof_area = read_matrix(t.dof_area, n_dofs, 1, "areas");
  op.loads.traction = read_matrix(t.locked, n_dofs, n_loads, "locked loads");
  op.observed.per_load = read_matrix(t.observed_load, n_observed, n_loads, "observed loads");
  op.observed.per_jump = read_matrix(t.observed_jump, n_observed, n_dofs, "observed jumps");
  return op;
}

}  // namespace faultsim
