#include "simulator/coupled/augmented.h"

#include <cmath>

namespace faultsim {

AugmentedJacobian augment(const SaddlePoint& j) {
  AugmentedJacobian out;
  out.springs.resize(j.n_multipliers());
  for (int k = 0; k < j.n_multipliers(); ++k) {
    double square = 0, gram = 0;
    for (SparseMatrix::InnerIterator a(j.constraint, k); a; ++a) {
      gram += a.value() * a.value();
      for (SparseMatrix::InnerIterator b(j.constraint, k); b; ++b) {
        const double entry = j.leading().coeff(a.row(), b.row());
        square += entry * entry;
      }
    }
    out.springs[k] = std::sqrt(square) / gram;
  }
  SaddlePoint& regular = out.regular;
  regular.set_leading(
      j.leading() + SparseMatrix(j.coupling * out.springs.asDiagonal() * j.constraint.transpose()));
  regular.constraint = regular.coupling = SparseMatrix(j.n_displacements(), 0);
  regular.node_begin = {0};
  regular.symmetric = j.symmetric;
  regular.rigid_motions = j.rigid_motions;
  return out;
}

}  // namespace faultsim
