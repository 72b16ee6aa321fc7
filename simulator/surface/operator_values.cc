#include "simulator/surface/operator_values.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

double relative(double error, double size) { return size > 0 ? error / size : error; }

/// Largest relative difference of the slip of faults without friction, H g = A L_k, over the loads:
/// the softest modes of H, which its norm does not show, weigh most here.
double slip_error(const FaultOperator& op, const FaultOperator& exact) {
  const Eigen::LLT<Eigen::MatrixXd> one(op.h()), other(exact.h());
  if (one.info() != Eigen::Success || other.info() != Eigen::Success)
    return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (Eigen::Index k = 0; k < exact.loads.traction.cols(); ++k) {
    const Eigen::VectorXd slip =
        other.solve(exact.geometry.dof_area.cwiseProduct(exact.loads.traction.col(k)));
    const Eigen::VectorXd other_slip =
        one.solve(op.geometry.dof_area.cwiseProduct(op.loads.traction.col(k)));
    worst = std::max(worst, relative((other_slip - slip).norm(), slip.norm()));
  }
  return worst;
}

}  // namespace

OperatorValues::OperatorValues(const FaultOperator& reference)
    : n_dofs_(reference.geometry.n_dofs),
      n_loads_(reference.loads.traction.cols()),
      n_rows_(reference.observed.per_load.rows()),
      keys_(reference.loads.keys) {
  const auto add = [&](Eigen::Index size) {
    if (size > 0) blocks_.push_back({size_, size, 1});
    size_ += size;
  };
  add(n_dofs_ * (n_dofs_ + 1) / 2);
  for (Eigen::Index k = 0; k < n_loads_; ++k) add(n_dofs_);
  add(n_rows_ * n_loads_);
  add(n_rows_ * n_dofs_);
  const Eigen::VectorXd values = unscaled(reference);
  for (Block& block : blocks_) {
    const double norm = values.segment(block.first, block.size).norm();
    if (norm > 0) block.scale = norm;
  }
}

Eigen::VectorXd OperatorValues::unscaled(const FaultOperator& op) const {
  FAULTSIM_DEMAND(op.geometry.n_dofs == n_dofs_ && op.loads.keys == keys_ &&
                      op.observed.per_load.rows() == n_rows_,
                  "operators of two shapes: ", op.geometry.n_dofs, " and ", n_dofs_, " jumps");
  Eigen::VectorXd values(size_);
  Eigen::Index at = 0;
  const auto h = op.h();
  for (Eigen::Index j = 0; j < n_dofs_; ++j) {
    values.segment(at, n_dofs_ - j) = h.col(j).tail(n_dofs_ - j);
    at += n_dofs_ - j;
  }
  for (const Eigen::MatrixXd* part :
       {&op.loads.traction, &op.observed.per_load, &op.observed.per_jump}) {
    values.segment(at, part->size()) =
        Eigen::Map<const Eigen::VectorXd>(part->data(), part->size());
    at += part->size();
  }
  return values;
}

Eigen::VectorXd OperatorValues::pack(const FaultOperator& op) const {
  Eigen::VectorXd values = unscaled(op);
  for (const Block& block : blocks_) values.segment(block.first, block.size) /= block.scale;
  return values;
}

void OperatorValues::unpack(const Eigen::VectorXd& values, FaultOperator& op) const {
  FAULTSIM_DEMAND(values.size() == size_, values.size(), " values for ", size_);
  Eigen::VectorXd real = values;
  for (const Block& block : blocks_) real.segment(block.first, block.size) *= block.scale;
  Eigen::MatrixXd h(n_dofs_, n_dofs_);
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < n_dofs_; ++j) {
    h.col(j).tail(n_dofs_ - j) = real.segment(at, n_dofs_ - j);
    at += n_dofs_ - j;
  }
  h.triangularView<Eigen::StrictlyUpper>() = h.transpose();
  op.compliance = std::make_shared<DenseCompliance>(std::move(h));
  op.loads.keys = keys_;
  const auto take = [&](Eigen::Index rows, Eigen::Index columns, Eigen::MatrixXd& into) {
    into = Eigen::Map<const Eigen::MatrixXd>(real.data() + at, rows, columns);
    at += rows * columns;
  };
  take(n_dofs_, n_loads_, op.loads.traction);
  take(n_rows_, n_loads_, op.observed.per_load);
  take(n_rows_, n_dofs_, op.observed.per_jump);
}

double OperatorValues::largest_block(const Eigen::VectorXd& difference) const {
  double largest = 0;
  for (const Block& block : blocks_)
    largest = std::max(largest, difference.segment(block.first, block.size).norm());
  return largest;
}

CaseSurface OperatorValues::errors(const FaultOperator& op, const FaultOperator& exact) {
  CaseSurface errors;
  errors.stiffness = relative((op.h() - exact.h()).norm(), exact.h().norm());
  const Eigen::MatrixXd difference = op.loads.traction - exact.loads.traction;
  for (Eigen::Index k = 0; k < difference.cols(); ++k) {
    errors.traction = std::max(
        errors.traction, relative(difference.col(k).norm(), exact.loads.traction.col(k).norm()));
  }
  const auto of_rows = [&](const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
    errors.observation = std::max(errors.observation, relative((one - other).norm(), other.norm()));
  };
  of_rows(op.observed.per_load, exact.observed.per_load);
  of_rows(op.observed.per_jump, exact.observed.per_jump);
  errors.slip = slip_error(op, exact);
  return errors;
}

}  // namespace faultsim
