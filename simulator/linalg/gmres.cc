#include "simulator/linalg/gmres.h"

#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <vector>

namespace faultsim {
namespace {

/// Orthonormal vectors, kept in blocks that are taken as they are needed.
class GrowingBasis {
 public:
  /// @param most  vectors: of few, one block has room for them all.
  GrowingBasis(Eigen::Index size, Eigen::Index most)
      : size_(size), width_(std::min<Eigen::Index>(most, 128)) {}
  void append(const Eigen::VectorXd& vector) {
    const Eigen::Index at = n_++ % width_;
    if (at == 0) blocks_.emplace_back(size_, width_);
    blocks_.back().col(at) = vector;
  }
  auto operator[](Eigen::Index j) const { return blocks_[j / width_].col(j % width_); }
  /// Σ y_j v_j over the first of them.
  Eigen::VectorXd combined(const Eigen::VectorXd& y) const {
    Eigen::VectorXd sum =
        blocks_[0].leftCols(std::min(y.size(), width_)) * y.head(std::min(y.size(), width_));
    for (Eigen::Index first = width_; first < y.size(); first += width_) {
      const Eigen::Index n = std::min(y.size() - first, width_);
      sum += blocks_[first / width_].leftCols(n) * y.segment(first, n);
    }
    return sum;
  }

 private:
  Eigen::Index size_, width_, n_ = 0;
  std::vector<Eigen::MatrixXd> blocks_;
};

/// v·w of vectors that several processes may have parts of.
template <typename Left>
double dot(const Left& v, const Eigen::VectorXd& w, const SumOverRanks& sum) {
  Eigen::Matrix<double, 1, 1> product(v.dot(w));
  if (sum) sum(product);
  return product[0];
}

double norm_of(const Eigen::VectorXd& v, const SumOverRanks& sum) {
  return sum ? std::sqrt(dot(v, v, sum)) : v.norm();
}

}  // namespace

GmresReport gmres(const LinearMap& multiply, const LinearMap& precondition,
                  const Eigen::VectorXd& b, double tolerance, int max_iterations,
                  Eigen::VectorXd& x, const SumOverRanks& sum,
                  const std::function<void()>& before_each) {
  GmresReport report;
  x.setZero(b.size());
  const double norm = norm_of(b, sum);
  if (norm == 0) return {true, 0, 0, {0}};
  report.residuals.push_back(1);
  GrowingBasis basis(b.size(), max_iterations + 1);
  Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(max_iterations + 1, max_iterations);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(max_iterations + 1);
  std::vector<Eigen::JacobiRotation<double>> rotations;
  Eigen::VectorXd z(b.size()), w(b.size());
  basis.append(b / norm);
  right[0] = norm;
  int j = 0;
  while (j < max_iterations && !report.converged) {
    if (before_each) before_each();
    w = basis[j];
    precondition(w, z);
    multiply(z, w);
    for (int i = 0; i <= j; ++i) {  // modified Gram-Schmidt
      hessenberg(i, j) = dot(basis[i], w, sum);
      w -= hessenberg(i, j) * basis[i];
    }
    hessenberg(j + 1, j) = norm_of(w, sum);
    if (!std::isfinite(hessenberg(j + 1, j))) return report;
    if (hessenberg(j + 1, j) > 0) basis.append(w / hessenberg(j + 1, j));
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
    report.residuals.push_back(report.relative_residual);
    report.converged = report.relative_residual <= tolerance;
    if (hessenberg(j - 1, j - 1) == 0) return report;
  }
  report.iterations = j;
  const Eigen::VectorXd y =
      hessenberg.topLeftCorner(j, j).triangularView<Eigen::Upper>().solve(right.head(j));
  w = basis.combined(y);
  precondition(w, x);
  return report;
}

}  // namespace faultsim
