#include "simulator/coupled/saddle_point.h"

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Triplets = std::vector<Eigen::Triplet<double, long>>;

/// Column c of A_k times the displacements' factors in the jump, as (own row, value).
std::vector<std::pair<int, double>> column_of(const TwoSidedNode& node, int c, int first_own) {
  std::vector<std::pair<int, double>> column;
  for (int i = 0; i < 3; ++i) {
    const double value = node.area * node.frame(i, c);
    if (value == 0) continue;
    for (const JumpTerm& term : node.terms)
      if (term.dof[i] >= 0) column.emplace_back(term.dof[i] - first_own, term.factor * value);
  }
  return column;
}

/// Writes the columns of one own node after another.
class BlockWriter {
 public:
  explicit BlockWriter(int first_own) : first_own_(first_own) {}
  void skip() { begin.push_back(n_multipliers); }
  void add(const TwoSidedNode& node, const NodeLinearisation& how) {
    begin.push_back(n_multipliers);
    if (how.state == FaultState::open || !node.may_jump(0)) return;
    const int normal = n_multipliers;
    const int n_held = how.state == FaultState::stick ? 3 : 1;
    for (int c = 0; c < n_held; ++c) {
      if (!node.may_jump(c)) continue;
      for (const auto& [dof, value] : column_of(node, c, first_own_)) {
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
      for (const auto& [row, row_value] : column_of(node, 1 + a, first_own_)) {
        friction.emplace_back(row, normal, -row_value * tangent.d_normal[a]);
        for (int b = 0; b < 2; ++b) {
          if (!node.may_jump(1 + b)) continue;
          for (const auto& [column, value] : column_of(node, 1 + b, first_own_)) {
            slip.emplace_back(row, column, row_value * tangent.d_slip(a, b) / node.area * value);
          }
        }
      }
    }
  }

  int first_own_;
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

const Ranks& SaddlePoint::ranks() const {
  static const Ranks alone;
  return bulk_ != nullptr ? bulk_->ranks() : alone;
}

bool SaddlePoint::has_engine() const { return bulk_ != nullptr ? bulk_->has_engine() : !!engine_; }

EngineMatrix& SaddlePoint::engine() const {
  if (bulk_ != nullptr) return bulk_->engine();
  if (!engine_) {
    engine_ = std::make_shared<EngineMatrix>(leading(), RowRanges::whole(n_displacements()),
                                             Ranks(), SparseMatrix());
  }
  return *engine_;
}

Eigen::VectorXd SaddlePoint::times_leading(const Eigen::VectorXd& u) const {
  if (bulk_ == nullptr) return leading() * u;
  Eigen::VectorXd out = bulk_->times_stiffness(u);
  if (slip.cols() > 0) out += slip * u;
  return out;
}

Eigen::MatrixXd SaddlePoint::motions() const {
  return bulk_ != nullptr && motions_.size() == 0 ? bulk_->rigid_motions() : motions_;
}

double SaddlePoint::leading_entry(int row, int column) const {
  if (!has_engine()) return leading().coeff(row, column);
  return engine().entry(row, column) + (slip.cols() > 0 ? slip.coeff(row, column) : 0);
}

Eigen::VectorXd SaddlePoint::leading_diagonal() const {
  if (bulk_ == nullptr) return leading().diagonal();
  Eigen::VectorXd diagonal = bulk_->diagonal();
  if (slip.cols() > 0) diagonal += slip.diagonal();
  return diagonal;
}

const SparseMatrix& SaddlePoint::leading() const {
  if (bulk_ != nullptr && slip.cols() == 0) return bulk_->stiffness();
  if (!leading_) leading_ = std::make_shared<const SparseMatrix>(bulk_->stiffness() + slip);
  return *leading_;
}

std::shared_ptr<const SparseMatrix> SaddlePoint::symmetric_leading() const {
  if (symmetric && bulk_ == nullptr) return leading_;
  if (symmetric) return {std::shared_ptr<void>(), &leading()};  // the bulk's
  return std::make_shared<const SparseMatrix>((leading() + SparseMatrix(leading().transpose())) /
                                              2);
}

void SaddlePoint::lend_leading(const SparseMatrix& matrix, Eigen::MatrixXd motions) {
  bulk_ = nullptr;
  engine_.reset();
  leading_ = {std::shared_ptr<void>(), &matrix};
  motions_ = std::move(motions);
}

void SaddlePoint::set_leading(SparseMatrix matrix, Eigen::MatrixXd motions) {
  bulk_ = nullptr;
  engine_.reset();
  leading_ = std::make_shared<const SparseMatrix>(std::move(matrix));
  motions_ = std::move(motions);
}

SaddlePoint make_saddle_point(const TwoSidedBulk& bulk,
                              const std::vector<NodeLinearisation>& nodes) {
  const std::vector<TwoSidedNode>& fault_nodes = bulk.fault_nodes();
  FAULTSIM_DEMAND(nodes.empty() || nodes.size() == fault_nodes.size(), nodes.size(), " states for ",
                  fault_nodes.size(), " nodes");
  BlockWriter writer(bulk.first_own());
  for (int k = 0; k < static_cast<int>(fault_nodes.size()); ++k) {
    if (bulk.owns(fault_nodes[k])) {
      writer.add(fault_nodes[k], nodes.empty() ? NodeLinearisation{} : nodes[k]);
    } else {
      writer.skip();
    }
  }
  writer.skip();
  const int n_u = bulk.n_own();
  SaddlePoint j;
  j.node_begin = writer.begin;
  j.constraint = matrix_of(writer.constraint, n_u, writer.n_multipliers);
  j.coupling = j.constraint;
  j.set_bulk(bulk);
  if (!writer.slip.empty()) {
    j.symmetric = false;
    j.coupling -= matrix_of(writer.friction, n_u, writer.n_multipliers);
    j.slip = matrix_of(writer.slip, n_u, n_u);
  }
  return j;
}

}  // namespace faultsim
