#include "simulator/coupled/saddle_point.h"

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Triplets = std::vector<Eigen::Triplet<double, long>>;

/// Column c of A_k times the displacements' factors in the jump, as (dof, value).
std::vector<std::pair<int, double>> column_of(const TwoSidedNode& node, int c) {
  std::vector<std::pair<int, double>> column;
  for (int i = 0; i < 3; ++i) {
    const double value = node.area * node.frame(i, c);
    if (value == 0) continue;
    for (const JumpTerm& term : node.terms)
      if (term.dof[i] >= 0) column.emplace_back(term.dof[i], term.factor * value);
  }
  return column;
}

/// Writes the columns of one node after another.
class BlockWriter {
 public:
  void add(const TwoSidedNode& node, const NodeLinearisation& how) {
    begin.push_back(n_multipliers);
    if (how.state == FaultState::open || !node.may_jump(0)) return;
    const int normal = n_multipliers;
    const int n_held = how.state == FaultState::stick ? 3 : 1;
    for (int c = 0; c < n_held; ++c) {
      if (!node.may_jump(c)) continue;
      for (const auto& [dof, value] : column_of(node, c)) {
        constraint.emplace_back(dof, n_multipliers, value);
      }
      ++n_multipliers;
    }
    if (how.state == FaultState::slip) add_slip(node, how.tangent, normal);
  }

  Triplets constraint, friction, slip;  ///< C, F, E
  std::vector<int> begin;
  int n_multipliers = 0;

 private:
  void add_slip(const TwoSidedNode& node, const SlipTangent& tangent, int normal) {
    for (int a = 0; a < 2; ++a) {
      if (!node.may_jump(1 + a)) continue;
      for (const auto& [row, row_value] : column_of(node, 1 + a)) {
        friction.emplace_back(row, normal, -row_value * tangent.d_normal[a]);
        for (int b = 0; b < 2; ++b) {
          if (!node.may_jump(1 + b)) continue;
          for (const auto& [column, value] : column_of(node, 1 + b)) {
            slip.emplace_back(row, column, row_value * tangent.d_slip(a, b) / node.area * value);
          }
        }
      }
    }
  }
};

SparseMatrix matrix_of(const Triplets& entries, int n_rows, int n_columns) {
  SparseMatrix matrix(n_rows, n_columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

Eigen::VectorXd SaddlePoint::gram() const {
  Eigen::VectorXd gram(n_multipliers());
  for (int j = 0; j < n_multipliers(); ++j) gram[j] = constraint.col(j).squaredNorm();
  return gram;
}

std::shared_ptr<const SparseMatrix> SaddlePoint::symmetric_leading() const {
  if (symmetric) return leading_;
  return std::make_shared<const SparseMatrix>((leading() + SparseMatrix(leading().transpose())) /
                                              2);
}

SaddlePoint make_saddle_point(const TwoSidedBulk& bulk,
                              const std::vector<NodeLinearisation>& nodes) {
  const std::vector<TwoSidedNode>& fault_nodes = bulk.fault_nodes();
  FAULTSIM_DEMAND(nodes.empty() || nodes.size() == fault_nodes.size(), nodes.size(), " states for ",
                  fault_nodes.size(), " nodes");
  BlockWriter writer;
  for (int k = 0; k < static_cast<int>(fault_nodes.size()); ++k) {
    writer.add(fault_nodes[k], nodes.empty() ? NodeLinearisation{} : nodes[k]);
  }
  writer.begin.push_back(writer.n_multipliers);
  const int n_u = bulk.n_displacements();
  SaddlePoint j;
  j.node_begin = writer.begin;
  j.constraint = matrix_of(writer.constraint, n_u, writer.n_multipliers);
  j.coupling = j.constraint;
  j.lend_leading(bulk.stiffness());
  if (!writer.slip.empty()) {
    j.symmetric = false;
    j.coupling -= matrix_of(writer.friction, n_u, writer.n_multipliers);
    j.set_leading(bulk.stiffness() + matrix_of(writer.slip, n_u, n_u));
  }
  j.rigid_motions = bulk.rigid_motions();
  return j;
}

}  // namespace faultsim
