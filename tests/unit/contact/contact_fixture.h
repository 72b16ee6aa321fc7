#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "simulator/contact/contact.h"
#include "simulator/contact/judge.h"

namespace faultsim {

inline void set_h(FaultOperator& op, Eigen::MatrixXd h) {
  op.compliance = std::make_shared<DenseCompliance>(std::move(h));
}

/// n nodes down dip on a vertical fault, 10 m apart, each with n_shear shear dofs (n, strike, dip).
inline FaultOperator make_operator(int n_nodes, int n_shear, const Eigen::VectorXd& node_area) {
  FaultOperator op;
  op.geometry.n_dofs = n_nodes * (1 + n_shear);
  op.geometry.plane_strain = n_shear == 1;
  op.geometry.dof_area.resize(op.geometry.n_dofs);
  op.geometry.faults.resize(1);
  op.geometry.faults[0].name = "main";
  op.geometry.faults[0].n_nodes = n_nodes;
  for (int k = 0; k < n_nodes; ++k) {
    OperatorNode node;
    node.position = Eigen::Vector3d(0, 0, -2000.0 - 10 * k);
    node.normal = Eigen::Vector3d(1, 0, 0);
    node.strike = Eigen::Vector3d(0, 1, 0);
    node.dip = Eigen::Vector3d(0, 0, -1);
    node.area = node_area[k];
    const int first = k * (1 + n_shear);
    node.dof = {first, n_shear == 2 ? first + 1 : -1, n_shear >= 1 ? first + n_shear : -1};
    op.geometry.dof_area.segment(first, 1 + n_shear).setConstant(node.area);
    op.geometry.nodes.push_back(node);
  }
  return op;
}

/// tan φ from 0.6 to 0.4 over d_c, linear in slip; no cohesion.
inline CoulombLaw linear_weakening(double d_c) {
  return {WeakeningLaw::coefficient, 0, std::atan(0.6), std::atan(0.4), d_c};
}

inline ContactLaws same_law(const FaultOperator& op, const CoulombLaw& law) {
  return ContactLaws(op.geometry.nodes.size(), law);
}

/// One node with H/A = k: the spring-slider.
inline FaultOperator spring_slider(double k, int n_shear, double area = 2.5) {
  FaultOperator op = make_operator(1, n_shear, Eigen::VectorXd::Constant(1, area));
  set_h(op, k * area * Eigen::MatrixXd::Identity(1 + n_shear, 1 + n_shear));
  return op;
}

/// A vertical fault in a half-space, roughly: the logarithmic kernel of edge dislocations between
/// nodes, with an image, and a weaker coupling of shear slip to normal traction.
inline Eigen::MatrixXd half_space_matrix(const FaultOperator& op, double shear_modulus,
                                         double coupling) {
  const int n = static_cast<int>(op.geometry.nodes.size());
  Eigen::MatrixXd single(n, n);
  // Piecewise constant slip on cells of one spacing: traction ~ 1/(x - a) - 1/(x - b), A times it.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double distance = i - j;
      const double image = i + j + 2 * 200.5;
      const double scale = shear_modulus / (2 * 3.14159265358979) * 1.25;
      single(i, j) = scale * (-1 / (distance * distance - 0.25) + 1 / (image * image - 0.25));
    }
  }
  const int stride = op.geometry.n_dofs / n;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(op.geometry.n_dofs, op.geometry.n_dofs);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int c = 0; c < stride; ++c) h(i * stride + c, j * stride + c) = single(i, j);
      if (i == j || stride < 2) continue;
      // Antisymmetric in distance, so that H as a whole stays symmetric.
      const double cross = coupling * single(i, j) * (i > j ? 1 : -1);
      h(i * stride, j * stride + stride - 1) += cross;
      h(j * stride + stride - 1, i * stride) += cross;
    }
  }
  return 0.5 * (h + h.transpose());
}

/// What the judge says of the end of a load step, and of its slip where it was made at once.
inline Verdict judged(const FaultOperator& op, const ContactLaws& laws,
                      const Eigen::VectorXd& locked_before, const Eigen::VectorXd& locked,
                      const ContactState& before, const ContactState& after, bool at_once = true) {
  return judge_step(op, laws, {locked_before, locked, before, after, at_once});
}

}  // namespace faultsim
