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

/// Terms that points on a line determine, and those of the plane, up to an order.
std::vector<int> terms_of(bool is_line, bool is_second) {
  if (is_line) return is_second ? std::vector{0, 1, 3} : std::vector{0, 1};
  return is_second ? std::vector{0, 1, 2, 3, 4, 5} : std::vector{0, 1, 2};
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
  const std::vector<int> terms = terms_of(is_line, is_second);
  MatrixXd matrix(points.size(), terms.size());
  VectorXd right(points.size());
  for (Eigen::Index row = 0; row < right.size(); ++row) {
    const SeenPoint& one = points[row];
    const double weight = 1 / (std::pow(one.away / reach_, 2) + kAtPlace * kAtPlace);
    const Terms all = terms_at(one.at.head<2>());
    for (std::size_t k = 0; k < terms.size(); ++k)
      matrix(row, static_cast<Eigen::Index>(k)) = weight * all[terms[k]];
    right[row] = weight * (one.at.z() - nearest_.z());
  }
  const VectorXd scale = matrix.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(kSameTerm);
  solver.compute(matrix * scale.asDiagonal());
  const VectorXd found = scale.cwiseProduct(solver.solve(right));
  for (std::size_t k = 0; k < terms.size(); ++k)
    factors_[terms[k]] = found[static_cast<Eigen::Index>(k)];
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
  return nearest_.z() + factors_.dot(terms_at(from + part * way));
}

}  // namespace faultsim::horizons
