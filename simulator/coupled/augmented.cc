#include "simulator/coupled/augmented.h"

#include <cmath>

namespace faultsim {
namespace {

SparseMatrix tied(const SaddlePoint& j, const Eigen::VectorXd& springs) {
  return j.constraint * springs.asDiagonal() * SparseMatrix(j.constraint.transpose());
}

}  // namespace

Eigen::VectorXd augmenting_springs(const SaddlePoint& j) {
  Eigen::VectorXd springs(j.n_multipliers());
  for (int k = 0; k < j.n_multipliers(); ++k) {
    double square = 0, gram = 0;
    for (SparseMatrix::InnerIterator a(j.constraint, k); a; ++a) {
      gram += a.value() * a.value();
      for (SparseMatrix::InnerIterator b(j.constraint, k); b; ++b) {
        const double entry = j.leading_entry(static_cast<int>(a.row()), static_cast<int>(b.row()));
        square += entry * entry;
      }
    }
    springs[k] = std::sqrt(square) / gram;
  }
  return springs;
}

SparseMatrix added_to_bulk(const SaddlePoint& j, const Eigen::VectorXd& springs) {
  SparseMatrix all(j.n_displacements(), j.n_displacements());
  if (springs.size() > 0) all = tied(j, springs);
  if (j.slip.cols() > 0) all += j.slip;
  return (all + SparseMatrix(all.transpose())) / 2;
}

SaddlePoint augmented(const SaddlePoint& j, const Eigen::VectorXd& springs) {
  SaddlePoint regular;
  regular.set_leading(j.leading() + tied(j, springs), j.motions());
  regular.constraint = regular.coupling = SparseMatrix(j.n_displacements(), 0);
  regular.node_begin = {0};
  regular.symmetric = j.symmetric;
  return regular;
}

}  // namespace faultsim
