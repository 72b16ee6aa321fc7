#include "simulator/horizons/local_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace faultsim::horizons {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kOnLine = 0.05;       // of their length across a line that points stand on
constexpr double kSameTerm = 1e-3;     // terms that points cannot tell apart
constexpr double kAtPlace = 1. / 100;  // of R
constexpr double kBeyond = 0.25;       // of the range of depths: what a bend may add to it

/// Terms that points on a line determine, and those of the plane, up to an order.
std::vector<int> terms_of(bool is_line, bool is_second) {
  if (is_line) return is_second ? std::vector{0, 1, 3} : std::vector{0, 1};
  return is_second ? std::vector{0, 1, 2, 3, 4, 5} : std::vector{0, 1, 2};
}

/// Least squares of some columns of a matrix, each scaled to a length of 1.
/// @returns a number per column, 0 where a column is not among them.
VectorXd least_squares(const MatrixXd& all, const VectorXd& right, const std::vector<int>& terms) {
  MatrixXd matrix(all.rows(), terms.size());
  for (std::size_t k = 0; k < terms.size(); ++k)
    matrix.col(static_cast<Eigen::Index>(k)) = all.col(terms[k]);
  const VectorXd scale = matrix.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(kSameTerm);
  solver.compute(matrix * scale.asDiagonal());
  const VectorXd some = scale.cwiseProduct(solver.solve(right));
  VectorXd found = VectorXd::Zero(all.cols());
  for (std::size_t k = 0; k < terms.size(); ++k)
    found[terms[k]] = some[static_cast<Eigen::Index>(k)];
  return found;
}

}  // namespace

LocalFit::LocalFit(const std::vector<SeenPoint>& points, double farthest)
    : nearest_(points.front().at), farthest_(farthest) {
  Vector2d middle = Vector2d::Zero();
  for (const SeenPoint& one : points) {
    reach_ = std::max(reach_, (one.at - nearest_).head<2>().norm());
    middle += one.at.head<2>() / static_cast<double>(points.size());
  }
  if (reach_ == 0) {
    reach_ = 1;  // of a single point, which is a constant
    return;
  }
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const SeenPoint& one : points)
    spread += (one.at.head<2>() - middle) * (one.at.head<2>() - middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(spread);
  axes_.row(0) = principal.eigenvectors().col(1);
  axes_.row(1) = principal.eigenvectors().col(0);
  const bool is_line = principal.eigenvalues()[0] < kOnLine * kOnLine * principal.eigenvalues()[1];
  const bool is_second = points.size() >= kForSecond && points.front().away <= reach_ / 2;
  MatrixXd matrix(points.size(), kTerms);
  VectorXd right(points.size());
  for (Eigen::Index row = 0; row < right.size(); ++row) {
    const SeenPoint& one = points[row];
    const double weight = 1 / (std::pow(one.away / reach_, 2) + kAtPlace * kAtPlace);
    const double z = one.at.z() - nearest_.z();
    matrix.row(row) = weight * terms_at(one.at.head<2>());
    right[row] = weight * z;
    low_ = std::min(low_, z);
    high_ = std::max(high_, z);
  }
  factors_ = plane_ = least_squares(matrix, right, terms_of(is_line, false));
  if (is_second) factors_ = least_squares(matrix, right, terms_of(is_line, true));
}

LocalFit::Terms LocalFit::terms_at(const Vector2d& place) const {
  Vector2d way = axes_ * (place - nearest_.head<2>()) / reach_;
  if (way.norm() > 1) way.normalize();
  const double u = way.x(), v = way.y();
  Terms terms;
  terms << 1, u, v, u * u, u * v, v * v;
  return terms;
}

double LocalFit::at(const Vector2d& place) const {
  const Vector2d from = nearest_.head<2>(), way = place - from;
  const double part = std::min(1.0, farthest_ / std::max(way.norm(), 1e-300));
  const Terms terms = terms_at(from + part * way);
  const double plane = plane_.dot(terms), slack = kBeyond * (high_ - low_);
  return nearest_.z() + std::clamp(factors_.dot(terms), std::min(low_, plane) - slack,
                                   std::max(high_, plane) + slack);
}

}  // namespace faultsim::horizons
