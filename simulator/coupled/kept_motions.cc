#include "simulator/coupled/kept_motions.h"

#include <Eigen/Cholesky>
#include <utility>

namespace faultsim {

LinearMap with_motions_kept(LinearMap block, const LinearMap& multiply,
                            const Eigen::MatrixXd& motions) {
  Eigen::MatrixXd r = motions, a_r(motions.rows(), motions.cols());
  Eigen::VectorXd product, step;
  for (int k = 0; k < r.cols(); ++k) {
    multiply(r.col(k), product);
    block(product, step);
    r.col(k) -= step;
    multiply(r.col(k), product);
    a_r.col(k) = product;
  }
  const Eigen::LDLT<Eigen::MatrixXd> energy(r.transpose() * a_r);
  return [=, block = std::move(block), r = std::move(r), a_r = std::move(a_r)](
             const Eigen::VectorXd& f, Eigen::VectorXd& z) {
    const Eigen::VectorXd first = energy.solve(r.transpose() * f);
    block(f - a_r * first, z);
    z += r * (first - energy.solve(a_r.transpose() * z));
  };
}

}  // namespace faultsim
