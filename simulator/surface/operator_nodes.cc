#include "simulator/surface/operator_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

using Piece = Eigen::Map<const Eigen::VectorXd>;

Piece all_of(const Eigen::MatrixXd& matrix) { return {matrix.data(), matrix.size()}; }

/// Column j of H from the diagonal down.
Piece below_diagonal(const FaultOperator& op, Eigen::Index j) {
  return {op.compliance->column(static_cast<int>(j)).data() + j, op.geometry.n_dofs - j};
}

/// visit(block, get) for every piece of an operator of this shape, get(op) being that of an
/// operator: the columns of the lower triangle of H, those of L, U and V.
template <typename Visit>
void for_each_piece(const FaultOperator& shape, StopToken stop, const Visit& visit) {
  const Eigen::Index n = shape.geometry.n_dofs;
  for (Eigen::Index j = 0; j < n; ++j) {
    stop.throw_if_requested("comparing operators");
    visit(std::size_t{0}, [j](const FaultOperator& op) { return below_diagonal(op, j); });
  }
  std::size_t block = 1;
  for (Eigen::Index k = 0; k < shape.loads.traction.cols(); ++k) {
    visit(block++, [k](const FaultOperator& op) {
      return Piece(op.loads.traction.col(k).data(), op.loads.traction.rows());
    });
  }
  visit(block++, [](const FaultOperator& op) { return all_of(op.observed.per_load); });
  visit(block, [](const FaultOperator& op) { return all_of(op.observed.per_jump); });
}

std::size_t n_blocks(const FaultOperator& op) {
  return 3 + static_cast<std::size_t>(op.loads.traction.cols());
}

}  // namespace

OperatorNodes::OperatorNodes(std::shared_ptr<const FaultOperator> centre)
    : nodes_{std::move(centre)}, scale_(n_blocks(*nodes_.front()), 0) {
  const FaultOperator& op = *nodes_.front();
  for_each_piece(
      op, {}, [&](std::size_t block, const auto& get) { scale_[block] += get(op).squaredNorm(); });
  for (double& one : scale_) one = one > 0 ? std::sqrt(one) : 1;
}

void OperatorNodes::add(std::shared_ptr<const FaultOperator> op) {
  const FaultOperator& first = *nodes_.front();
  FAULTSIM_DEMAND(
      op->geometry.n_dofs == first.geometry.n_dofs && op->loads.keys == first.loads.keys &&
          op->observed.per_load.rows() == first.observed.per_load.rows(),
      "operators of two shapes: ", op->geometry.n_dofs, " and ", first.geometry.n_dofs, " jumps");
  nodes_.push_back(std::move(op));
}

double OperatorNodes::surplus(const FaultOperator& op, const Eigen::VectorXd& weights,
                              StopToken stop) const {
  FAULTSIM_DEMAND(weights.size() == static_cast<Eigen::Index>(nodes_.size()), weights.size());
  std::vector<double> squares(scale_.size(), 0);
  Eigen::VectorXd off;
  for_each_piece(op, stop, [&](std::size_t block, const auto& get) {
    off = get(op);
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      const double w = weights[k];
      if (w != 0) off -= w * get(*nodes_[k]);
    }
    squares[block] += off.squaredNorm();
  });
  double largest = 0;
  for (std::size_t b = 0; b < squares.size(); ++b)
    largest = std::max(largest, std::sqrt(squares[b]) / scale_[b]);
  return largest;
}

Eigen::MatrixXd OperatorNodes::stiffness_gram(StopToken stop) const {
  const auto m = static_cast<Eigen::Index>(nodes_.size()) - 1;
  const Eigen::Index n = nodes_.front()->geometry.n_dofs;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, m), moved;
  for (Eigen::Index j = 0; j < n; ++j) {
    stop.throw_if_requested("comparing operators");
    const Piece centre = below_diagonal(*nodes_.front(), j);
    moved.resize(n - j, m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const FaultOperator& node = *nodes_[static_cast<std::size_t>(i) + 1];
      moved.col(i) = (below_diagonal(node, j) - centre) / scale_.front();
    }
    sum.noalias() += moved.transpose() * moved;
  }
  return sum;
}

/// B, node by node and not as a product of matrices, whose order of sums depends on the place:
/// entries (i, j) and (j, i) are to be the same.
void OperatorNodes::add_directions(const Eigen::MatrixXd& directions, StopToken stop,
                                   OperatorBasis& basis) const {
  const FaultOperator& centre = *nodes_.front();
  const Eigen::Index n = centre.geometry.n_dofs, k = directions.cols();
  Eigen::MatrixXf stiffness(n, n * k);
  basis.diagonal.resize(n, k);
  Eigen::MatrixXd columns(n, k);
  Eigen::VectorXd moved;
  for (Eigen::Index j = 0; j < n; ++j) {
    stop.throw_if_requested("compressing operators");
    const auto at = static_cast<int>(j);
    columns.setZero();
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
      moved = nodes_[i]->compliance->column(at) - centre.compliance->column(at);
      for (Eigen::Index d = 0; d < k; ++d)
        columns.col(d) += directions(static_cast<Eigen::Index>(i) - 1, d) * moved;
    }
    stiffness.middleCols(j * k, k) = columns.cast<float>();
    basis.diagonal.row(j) = stiffness.row(j).segment(j * k, k).cast<double>();
  }
  basis.stiffness = StoredFloats(std::move(stiffness));
}

OperatorBasis OperatorNodes::basis(const Eigen::MatrixXd& directions, StopToken stop) const {
  OperatorBasis basis;
  basis.centre = nodes_.front();
  basis.weights = directions.transpose();
  add_directions(directions, stop, basis);
  const auto differences = [&](const auto& get) {
    const Eigen::VectorXd centre = all_of(get(*nodes_.front()));
    Eigen::MatrixXd columns(centre.size(), static_cast<Eigen::Index>(nodes_.size()) - 1);
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      columns.col(static_cast<Eigen::Index>(i) - 1) = all_of(get(*nodes_[i])) - centre;
    return columns;
  };
  basis.traction = differences([](const FaultOperator& op) -> auto& { return op.loads.traction; });
  basis.per_load =
      differences([](const FaultOperator& op) -> auto& { return op.observed.per_load; });
  basis.per_jump =
      differences([](const FaultOperator& op) -> auto& { return op.observed.per_jump; });
  return basis;
}

}  // namespace faultsim
