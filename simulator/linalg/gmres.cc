#include "simulator/linalg/gmres.h"

#include <Eigen/Jacobi>
#include <cmath>
#include <vector>

namespace faultsim {

GmresReport gmres(const LinearMap& multiply, const LinearMap& precondition,
                  const Eigen::VectorXd& b, double tolerance, int max_iterations,
                  Eigen::VectorXd& x) {
  GmresReport report;
  x.setZero(b.size());
  const double norm = b.norm();
  if (norm == 0) return {true, 0, 0};
  Eigen::MatrixXd basis(b.size(), max_iterations + 1);
  Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(max_iterations + 1, max_iterations);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(max_iterations + 1);
  std::vector<Eigen::JacobiRotation<double>> rotations;
  Eigen::VectorXd z(b.size()), w(b.size());
  basis.col(0) = b / norm;
  right[0] = norm;
  int j = 0;
  while (j < max_iterations && !report.converged) {
    w = basis.col(j);
    precondition(w, z);
    multiply(z, w);
    for (int i = 0; i <= j; ++i) {  // modified Gram-Schmidt
      hessenberg(i, j) = basis.col(i).dot(w);
      w -= hessenberg(i, j) * basis.col(i);
    }
    hessenberg(j + 1, j) = w.norm();
    if (!std::isfinite(hessenberg(j + 1, j))) return report;
    if (hessenberg(j + 1, j) > 0) basis.col(j + 1) = w / hessenberg(j + 1, j);
    for (int i = 0; i < j; ++i) {
      hessenberg.col(j).applyOnTheLeft(i, i + 1, rotations[i].adjoint());
    }
    Eigen::JacobiRotation<double> rotation;
    rotation.makeGivens(hessenberg(j, j), hessenberg(j + 1, j));
    hessenberg.col(j).applyOnTheLeft(j, j + 1, rotation.adjoint());
    right.applyOnTheLeft(j, j + 1, rotation.adjoint());
    rotations.push_back(rotation);
    ++j;
    report.relative_residual = std::abs(right[j]) / norm;
    report.converged = report.relative_residual <= tolerance;
    if (hessenberg(j - 1, j - 1) == 0) return report;
  }
  report.iterations = j;
  const Eigen::VectorXd y =
      hessenberg.topLeftCorner(j, j).triangularView<Eigen::Upper>().solve(right.head(j));
  w = basis.leftCols(j) * y;
  precondition(w, x);
  return report;
}

}  // namespace faultsim
