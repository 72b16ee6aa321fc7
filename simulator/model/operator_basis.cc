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
    : basis_(std::move(basis)), factors_(std::move(factors)) {
  FAULTSIM_DEMAND(factors_.size() == basis_->size(), factors_.size(), " factors of ",
                  basis_->size());
  const auto h = basis_->centre->h();
  diagonal_ = h.diagonal();
  for (Eigen::Index k = 0; k < factors_.size(); ++k)
    diagonal_ += factors_[k] * basis_->diagonal.col(k);
  const auto n = static_cast<std::size_t>(h.rows());
  entries_.reset(new double[n * n]);  // not set to 0: that would touch all of it
  made_.resize(n, false);
}

/// Every entry is summed in the same order, so that H is symmetric to the last bit.
Compliance::Column InterpolatedCompliance::column(int j) const {
  const Eigen::Index n = size();
  double* const values = entries_.get() + j * n;
  if (!made_[static_cast<std::size_t>(j)]) {
    Eigen::Map<Eigen::VectorXd> sum(values, n);
    sum = basis_->centre->h().col(j);
    const auto b = basis_->stiffness.view().middleCols(j * factors_.size(), factors_.size());
    for (Eigen::Index k = 0; k < factors_.size(); ++k) sum += factors_[k] * b.col(k).cast<double>();
    made_[static_cast<std::size_t>(j)] = true;
    ++n_made_;
  }
  return {values, n};
}

const double* InterpolatedCompliance::matrix_entries() const {
  for (int j = 0; j < size(); ++j) column(j);
  return entries_.get();
}

}  // namespace faultsim
