#include "simulator/coupled/kept_motions.h"

#include <Eigen/Cholesky>
#include <utility>

namespace faultsim {

namespace {

/// leftᵀ right, of all ranks.
Eigen::MatrixXd products(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right,
                         const SumOverRanks& sum) {
  Eigen::MatrixXd all = left.transpose() * right;
  if (sum) sum(Eigen::Map<Eigen::VectorXd>(all.data(), all.size()));
  return all;
}

}  // namespace

LinearMap with_motions_kept(LinearMap block, const LinearMap& multiply,
                            const Eigen::MatrixXd& motions, const SumOverRanks& sum) {
  Eigen::MatrixXd r = motions, a_r(motions.rows(), motions.cols());
  Eigen::VectorXd product, step;
  for (int k = 0; k < r.cols(); ++k) {
    multiply(r.col(k), product);
    block(product, step);
    r.col(k) -= step;
    multiply(r.col(k), product);
    a_r.col(k) = product;
  }
  const Eigen::LDLT<Eigen::MatrixXd> energy(products(r, a_r, sum));
  return [=, block = std::move(block), r = std::move(r), a_r = std::move(a_r)](
             const Eigen::VectorXd& f, Eigen::VectorXd& z) {
    const Eigen::VectorXd first = energy.solve(products(r, f, sum));
    block(f - a_r * first, z);
    z += r * (first - energy.solve(products(a_r, z, sum)));
  };
}

}  // namespace faultsim
