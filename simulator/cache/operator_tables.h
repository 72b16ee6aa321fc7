#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "simulator/cache/table_archive.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// The file of an operator or surface in a cache.
inline std::filesystem::path cached_file(const std::filesystem::path& folder,
                                         const std::string& fingerprint) {
  return folder / (fingerprint + ".h5");
}

/// Throws StorageError where an index of the operator points at nothing.
void check_indices(const FaultOperator& op);

/// Where the nodes of the faults are.
template <typename Nodes, typename Archive>
void node_tables(Nodes& nodes, const Archive& archive) {
  archive.list("/nodes/position", nodes, &OperatorNode::position, {"m", "position"});
  archive.rows("/nodes/normal", nodes, &OperatorNode::normal,
               {"1", "normal, from the minus to the plus side"});
  archive.rows("/nodes/strike", nodes, &OperatorNode::strike, {"1", "strike direction"});
  archive.rows("/nodes/dip", nodes, &OperatorNode::dip, {"1", "dip direction, normal x strike"});
}

template <typename Observed, typename Archive>
void observation_tables(Observed& rows, const Archive& archive) {
  archive.list("/observations/names", rows, &ObservationRow::name);
  archive.rows("/observations/position", rows, &ObservationRow::position, {"m", "nodes observed"});
}

template <typename Geometry, typename Archive>
void geometry_tables(Geometry& geometry, const Archive& archive) {
  auto& nodes = geometry.nodes;
  node_tables(nodes, archive);
  archive.rows("/nodes/numbers", nodes,
               [](auto& node) {
                 return cells(node.area, node.effective_shear_modulus, node.poisson_ratio,
                              node.edge_strike, node.edge_dip);
               },
               {"m2, Pa, 1, m, m",
                "area, effective shear modulus, Poisson ratio, edge along strike, edge down dip"});
  archive.rows("/nodes/dof", nodes, &OperatorNode::dof,
               {"", "index of the jump in normal, strike, dip; -1 removed"});
  archive.rows("/nodes/n_pairs", nodes, [](auto& node) { return length(node.pressure); },
               {"", "number of pressure pairs of the node"});
  archive.rows("/pairs/regions", items_of(nodes, &OperatorNode::pressure),
               [](auto& pair) { return cells(pair.minus_region, pair.plus_region); },
               {"", "pressure region minus, plus; -1 none"});
  archive.rows(
      "/pairs/numbers", items_of(nodes, &OperatorNode::pressure),
      [](auto& pair) { return cells(pair.minus_fraction, pair.plus_fraction, pair.weight); },
      {"1", "fraction minus, fraction plus, weight"});
  auto& faults = geometry.faults;
  archive.list("/faults/names", faults, &OperatorFault::name);
  archive.rows("/faults/numbers", faults,
               [](auto& fault) {
                 return cells(fault.first_node, fault.n_nodes,
                              length(fault.points, fault.node_of_point), length(fault.faces));
               },
               {"", "first node, nodes, points, faces"});
  archive.rows("/faults/points", items_of(faults, &OperatorFault::points), std::identity(),
               {"m", "points of all faults"});
  archive.rows("/faults/node_of_point", items_of(faults, &OperatorFault::node_of_point),
               std::identity(), {"", "node at the point; -1 not split"});
  archive.rows("/faults/faces", items_of(faults, &OperatorFault::faces), std::identity(),
               {"", "points at the faces' corners"});
  archive.list("/locked_positions", geometry.locked_positions, std::identity(),
               {"m", "nodes held closed by a boundary"});
  archive.matrix("/dof_area", geometry.dof_area, geometry.n_dofs, 1, {"m2", "A per dof"});
}

/// An operator without H.
template <typename Op, typename Archive>
void operator_tables(Op& op, const Archive& archive) {
  auto& geometry = op.geometry;
  archive.values("/fingerprint", cells(op.fingerprint));
  archive.values("/made_with/blas", cells(op.blas));
  archive.values("/made_with/cost", cells(op.build_seconds, op.factor_bytes),
                 {"s, B", "build time, bytes of the factor"});
  archive.values("/sizes",
                 cells(geometry.n_dofs, geometry.plane_strain, geometry.half_domain, op.n_unknowns),
                 {"", "n_dofs, plane_strain, half_domain, n_unknowns"});
  if (geometry.n_dofs < 0) throw StorageError("the tables disagree: /sizes");
  geometry_tables(geometry, archive);
  archive.list(
      "/loads/keys", op.loads.keys,
      [](auto& key) { return cells(key.kind, key.index, key.material); },
      {"",
       "0 pressure, 1 boundary; region or boundary condition; material of the region, -1 none"});
  const auto n_loads = static_cast<Eigen::Index>(op.loads.keys.size());
  archive.matrix("/loads/locked", op.loads.traction, geometry.n_dofs, n_loads,
                 {"Pa per unit of load", "L, column by column"});
  observation_tables(op.observed.rows, archive);
  const auto n_rows = static_cast<Eigen::Index>(op.observed.rows.size());
  archive.matrix("/observations/load", op.observed.per_load, n_rows, n_loads,
                 {"m per unit of load", "U, column by column"});
  archive.matrix("/observations/jump", op.observed.per_jump, n_rows, geometry.n_dofs,
                 {"m per m", "V, column by column"});
  if constexpr (Archive::kReads) {
    check_indices(op);
    for (OperatorFault& fault : geometry.faults)
      fault.profiles = fault_profiles(fault, geometry.nodes);
  }
}

/// H of an operator whose other tables are there.
template <typename Op, typename Archive>
void stiffness_table(Op& op, const Archive& archive, const char* long_name) {
  const int n = op.geometry.n_dofs;
  StoredMatrix h(op.compliance->matrix_entries(), n, n, op.compliance);
  archive.array("/h", h, n, n, {"N/m", long_name});
  if constexpr (Archive::kReads) op.compliance = std::make_shared<DenseCompliance>(h);
}

}  // namespace faultsim
