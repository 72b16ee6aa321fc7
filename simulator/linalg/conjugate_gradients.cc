#include "simulator/linalg/conjugate_gradients.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace faultsim {
namespace {

/// T of the Lanczos process that the iteration is: VᵀA V = T with VᵀM V = I.
class LanczosMatrix {
 public:
  /// @param alpha  length of a step. @param beta  what its direction has of the one before.
  void append(double alpha, double beta) {
    const bool first = diagonal_.empty();
    diagonal_.push_back(1 / alpha + (first ? 0 : beta / last_));
    if (!first) beside_.push_back(std::sqrt(beta) / last_);
    last_ = alpha;
  }
  double smallest_eigenvalue() const {
    const Eigen::Map<const Eigen::VectorXd> diagonal(diagonal_.data(), std::ssize(diagonal_));
    const Eigen::Map<const Eigen::VectorXd> beside(beside_.data(), std::ssize(beside_));
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[0];
  }

 private:
  std::vector<double> diagonal_, beside_;
  double last_ = 0;  ///< alpha of the last step.
};

class Iteration {
 public:
  Iteration(const LinearMap& multiply, const LinearMap& precondition, double tolerance, int most)
      : multiply_(multiply), precondition_(precondition), tolerance_(tolerance), most_(most) {}

  CgReport run(const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  bool go_on(Eigen::VectorXd& x);
  bool within_tolerance(double square, const LanczosMatrix& lanczos);
  /// @param square  ρᵀM⁻¹ρ.
  void bound(double square) {
    constexpr double kSure = 0.5;  // of the smallest Ritz value
    report_.energy_error = std::sqrt(std::max(square, 0.0) / (kSure * report_.least_ritz));
  }

  const LinearMap& multiply_;
  const LinearMap& precondition_;
  double tolerance_;
  int most_;
  CgReport report_;
  Eigen::VectorXd residual_, z_, direction_, product_;
};

/// Eigenvalues are asked for only where they decide.
bool Iteration::within_tolerance(double square, const LanczosMatrix& lanczos) {
  bound(square);
  if (!(report_.energy_error <= tolerance_)) return false;
  report_.least_ritz = std::min(report_.least_ritz, lanczos.smallest_eigenvalue());
  bound(square);
  return report_.energy_error <= tolerance_;
}

/// From x with residual_. @returns whether the bound holds by the recurrence.
bool Iteration::go_on(Eigen::VectorXd& x) {
  LanczosMatrix lanczos;
  precondition_(residual_, z_);
  direction_ = z_;
  double square = residual_.dot(z_), beta = 0;
  if (report_.iterations == 0) tolerance_ *= std::sqrt(std::max(square, 0.0));
  while (report_.iterations < most_) {
    multiply_(direction_, product_);
    const double curvature = direction_.dot(product_);
    if (!(square > 0 && curvature > 0)) return false;  // not definite, or not a number
    const double alpha = square / curvature;
    x += alpha * direction_;
    residual_ -= alpha * product_;
    lanczos.append(alpha, beta);
    ++report_.iterations;
    precondition_(residual_, z_);
    const double next = residual_.dot(z_);
    if (within_tolerance(next, lanczos)) return true;
    beta = next / square;
    square = next;
    direction_ = z_ + beta * direction_;
  }
  return false;
}

CgReport Iteration::run(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  residual_ = b;
  z_.resize(b.size());
  product_.resize(b.size());
  constexpr int kMostRuns = 4;  // each begins where rounding ended the one before
  for (int i = 0; i < kMostRuns; ++i) {
    if (!go_on(x)) break;
    report_.converged = report_.iterations == 1;  // the recurrence has just computed it afresh
    if (report_.converged) break;
    multiply_(x, product_);
    residual_ = b - product_;
    precondition_(residual_, z_);
    bound(residual_.dot(z_));
    report_.converged = report_.energy_error <= tolerance_;
    if (report_.converged) break;
  }
  return report_;
}

}  // namespace

CgReport conjugate_gradients(const LinearMap& multiply, const LinearMap& precondition,
                             const Eigen::VectorXd& b, double tolerance, int max_iterations,
                             Eigen::VectorXd& x) {
  x.setZero(b.size());
  if (b.isZero(0)) return {true, 0, 0, 1};
  return Iteration(multiply, precondition, tolerance, max_iterations).run(b, x);
}

}  // namespace faultsim
