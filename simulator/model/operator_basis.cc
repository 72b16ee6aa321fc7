#include "simulator/model/operator_basis.h"

#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {

void OperatorBasis::put(const std::shared_ptr<const OperatorBasis>& basis, const Eigen::VectorXd& w,
                        FaultOperator& op) {
  const FaultOperator& centre = *basis->centre;
  const auto at = [&](const Eigen::MatrixXd& mean, const Eigen::MatrixXd& differences) {
    Eigen::MatrixXd value = mean;
    value.reshaped() += differences * w;
    return value;
  };
  op.loads.keys = centre.loads.keys;
  op.loads.traction = at(centre.loads.traction, basis->traction);
  op.observed.rows = centre.observed.rows;
  op.observed.per_load = at(centre.observed.per_load, basis->per_load);
  op.observed.per_jump = at(centre.observed.per_jump, basis->per_jump);
  op.compliance = std::make_shared<InterpolatedCompliance>(basis, basis->weights * w);
  op.n_unknowns = centre.n_unknowns;
  op.blas = centre.blas;
}

InterpolatedCompliance::InterpolatedCompliance(std::shared_ptr<const OperatorBasis> basis,
                                               Eigen::VectorXd factors)
    : basis_(std::move(basis)),
      directions_(basis_->stiffness, std::move(factors)),
      made_(static_cast<std::size_t>(basis_->stiffness.n_runs()), false) {
  const auto h = basis_->centre->h();
  diagonal_ = h.diagonal() + directions_.diagonal();
  const auto n = static_cast<std::size_t>(h.rows());
  entries_.reset(new double[n * n]);  // not set to 0: that would touch all of it
}

Compliance::Column InterpolatedCompliance::column(int j) const {
  const Eigen::Index n = size();
  const DirectionBlocks& blocks = basis_->stiffness;
  const int run = blocks.run_of(j);
  if (!made_[static_cast<std::size_t>(run)]) {
    const Eigen::Index first = blocks.begin[run], width = blocks.n_in(run);
    Eigen::Map<Eigen::MatrixXd> columns(entries_.get() + first * n, n, width);
    columns = basis_->centre->h().middleCols(first, width);
    directions_.add_columns(run, columns);
    made_[static_cast<std::size_t>(run)] = true;
    n_made_ += static_cast<int>(width);
  }
  return {entries_.get() + j * n, n};
}

const double* InterpolatedCompliance::matrix_entries() const {
  for (int run = 0; run < basis_->stiffness.n_runs(); ++run) column(basis_->stiffness.begin[run]);
  return entries_.get();
}

}  // namespace faultsim
