#include "simulator/surface/stability_limit.h"

#include <cmath>
#include <limits>

#include "simulator/linalg/dense_cholesky.h"

namespace faultsim {
namespace {

/// The slips of a fault.
std::vector<int> slips_of(const FaultGeometry& faults, const OperatorFault& fault) {
  std::vector<int> dofs;
  for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
    for (const std::size_t c : {1, 2}) {
      const int dof = faults.nodes[k].dof[c];
      if (dof >= 0) dofs.push_back(dof);
    }
  }
  return dofs;
}

/// The least eigenvalue of a symmetric positive definite matrix.
double least_eigenvalue(const Eigen::MatrixXd& matrix) {
  constexpr int kMost = 1000;
  constexpr double kSettled = 1e-10;
  DenseCholesky factor;
  if (matrix.rows() == 0 || !factor.factor(matrix)) return std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd x = Eigen::VectorXd::Ones(matrix.rows()).normalized();
  double inverse = 0;
  for (int i = 0; i < kMost; ++i) {
    const Eigen::VectorXd y = factor.solve(x);
    const double next = x.dot(y);
    x = y.normalized();
    if (std::abs(next - inverse) <= kSettled * next) return 1 / next;
    inverse = next;
  }
  return 1 / inverse;
}

}  // namespace

std::vector<double> stability_limits(const FaultGeometry& faults,
                                     const Eigen::Ref<const Eigen::MatrixXd>& h) {
  std::vector<double> limits;
  for (const OperatorFault& fault : faults.faults) {
    const std::vector<int> dofs = slips_of(faults, fault);
    const auto n = static_cast<Eigen::Index>(dofs.size());
    Eigen::MatrixXd scaled(n, n);  // A^-1/2 H A^-1/2
    for (Eigen::Index j = 0; j < n; ++j) {
      const int column = dofs[j];
      for (Eigen::Index i = 0; i < n; ++i) {
        const int row = dofs[i];
        scaled(i, j) = h(row, column) / std::sqrt(faults.dof_area[row] * faults.dof_area[column]);
      }
    }
    limits.push_back(least_eigenvalue(scaled));
  }
  return limits;
}

}  // namespace faultsim
