#include "simulator/surface/operator_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/linalg/shared_bases.h"

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

void append(const Eigen::MatrixXd& values, std::vector<float>& to) {
  to.insert(to.end(), values.data(), values.data() + values.size());
}

/// Square matrices side by side, each with its lower triangle in the upper one.
Eigen::MatrixXd each_symmetric(Eigen::MatrixXd side_by_side) {
  const Eigen::Index n = side_by_side.rows();
  for (Eigen::Index first = 0; first < side_by_side.cols(); first += n) {
    auto one = side_by_side.middleCols(first, n);
    one.triangularView<Eigen::StrictlyUpper>() = one.transpose();
  }
  return side_by_side;
}

StoredFloats stored(std::vector<float> values) {
  const auto kept = std::make_shared<const std::vector<float>>(std::move(values));
  return {kept->data(), static_cast<Eigen::Index>(kept->size()), 1, kept};
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

/// Rows and columns of B_1, …, B_K side by side.
Eigen::MatrixXd OperatorNodes::block(const Eigen::MatrixXd& directions, const RowRange& rows,
                                     const RowRange& columns) const {
  const auto m = static_cast<Eigen::Index>(nodes_.size()) - 1;
  const Eigen::Index size = Eigen::Index{rows.n} * columns.n;
  const auto part = [&](const FaultOperator& op) {
    return op.h().block(rows.first, columns.first, rows.n, columns.n);
  };
  const Eigen::MatrixXd centre = part(*nodes_.front());
  Eigen::MatrixXd moved(size, m);
  for (Eigen::Index i = 0; i < m; ++i)
    moved.col(i) = (part(*nodes_[static_cast<std::size_t>(i) + 1]) - centre).reshaped();
  return times_transpose(moved, directions.transpose())
      .reshaped(rows.n, columns.n * directions.cols());
}

/// Each pair of runs may leave out the same.
DirectionBlocks OperatorNodes::blocks(const Eigen::MatrixXd& directions, double left_out,
                                      StopToken stop) const {
  DirectionBlocks blocks;
  blocks.count = static_cast<int>(directions.cols());
  blocks.begin = jump_runs(nodes_.front()->geometry.n_dofs);
  const int n_runs = blocks.n_runs();
  const double of_a_pair =
      std::pow(left_out * scale_.front(), 2) / std::max(1, n_runs * (n_runs - 1) / 2);
  std::vector<float> near, far;
  for (int s = 0; s < n_runs; ++s) {
    const RowRange columns{blocks.begin[s], blocks.n_in(s)};
    for (int t = 0; t < s; ++t) {
      stop.throw_if_requested("compressing operators");
      const SharedBases shared = shared_bases(
          block(directions, {blocks.begin[t], blocks.n_in(t)}, columns), columns.n, of_a_pair);
      blocks.ranks.push_back(
          {static_cast<int>(shared.u.cols()), static_cast<int>(shared.v.cols())});
      append(shared.u, far);
      append(shared.v, far);
      append(shared.cores, far);
    }
    append(each_symmetric(block(directions, columns, columns)), near);
  }
  blocks.near = stored(std::move(near));
  blocks.far = stored(std::move(far));
  return blocks;
}

OperatorBasis OperatorNodes::basis(const Eigen::MatrixXd& directions, double left_out,
                                   StopToken stop) const {
  OperatorBasis basis;
  basis.centre = nodes_.front();
  basis.weights = directions.transpose();
  basis.stiffness = blocks(directions, left_out, stop);
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
