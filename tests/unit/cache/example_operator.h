#pragma once

#include <Eigen/Geometry>
#include <string>

#include "simulator/common/fingerprint.h"
#include "simulator/model/fault_operator.h"
#include "tests/unit/files/scratch_folder.h"

namespace faultsim {

/// A fault of 3 x 4 points of which the inner ones are split; every number is different.
inline OperatorFault example_fault(FaultGeometry& geometry, const std::string& name, double x) {
  OperatorFault fault;
  fault.name = name;
  fault.first_node = static_cast<int>(geometry.nodes.size());
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 4; ++row) {
      const bool split = column == 1 && row > 0 && row < 3;
      fault.points.emplace_back(x, 100.0 * column, -2000 - 50.0 * row);
      fault.node_of_point.push_back(split ? static_cast<int>(geometry.nodes.size()) : -1);
      if (!split) continue;
      OperatorNode node;
      node.position = fault.points.back();
      node.normal = {0.8, 0, 0.6};
      node.strike = {0, 1, 0};
      node.dip = node.normal.cross(node.strike);
      node.area = 5000 + row;
      for (int& dof : node.dof) dof = geometry.n_dofs++;
      node.effective_shear_modulus = 4.4e9 + row;
      node.poisson_ratio = 0.15;
      node.edge_strike = 100;
      node.edge_dip = 50;
      node.pressure = {{0, 1.0, -1, 0, 0.25}, {0, 0.5, 1, 0.75, 0.75}};
      if (row == 2) node.pressure.pop_back();
      geometry.nodes.push_back(node);
    }
  }
  fault.n_nodes = 2;
  for (int column = 0; column < 2; ++column) {
    for (int row = 0; row < 3; ++row) {
      const int at = 4 * column + row;
      fault.faces.push_back({at, at + 1, at + 5, at + 4});
    }
  }
  fault.profiles = fault_profiles(fault, geometry.nodes);
  return fault;
}

/// Two faults, `n_extra` more dofs without nodes to make H large.
inline FaultOperator example_operator(const std::string& key, int n_extra = 0) {
  FaultOperator op;
  op.fingerprint = fingerprint(key);
  FaultGeometry& geometry = op.geometry;
  geometry.faults.push_back(example_fault(geometry, "F1", 0));
  geometry.faults.push_back(example_fault(geometry, "F2 <east> & co/1", 2000));
  geometry.nodes.back().dof[0] = -1;  // removed by symmetry
  geometry.n_dofs += n_extra;
  geometry.half_domain = true;
  geometry.locked_positions = {{1, 2, 3}, {4, 5, 6}};
  const Eigen::Index n = geometry.n_dofs;
  op.geometry.dof_area = Eigen::VectorXd::LinSpaced(n, 1, 2);
  op.loads.keys = {{LoadKey::Kind::pressure, 0, 2},
                   {LoadKey::Kind::pressure, 1, 2},
                   {LoadKey::Kind::boundary, 2}};
  op.loads.traction = Eigen::MatrixXd::Random(n, 3);
  op.observed.rows = {{"above_centre.z", {0, 0, 0}}, {"above_centre.x", {0.1, 0, 0}}};
  op.observed.per_load = Eigen::MatrixXd::Random(2, 3);
  op.observed.per_jump = Eigen::MatrixXd::Random(2, n);
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(n, n);
  op.compliance = std::make_shared<DenseCompliance>(random + random.transpose());
  op.n_unknowns = 123456;
  op.build_seconds = 1.5;
  op.factor_bytes = 4e9;
  op.blas = "OpenBLAS 0.3.21 Haswell, 1 thread";
  return op;
}

}  // namespace faultsim
