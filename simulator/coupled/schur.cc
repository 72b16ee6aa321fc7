#include "simulator/coupled/schur.h"

#include <Eigen/LU>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/linalg/growing_lu.h"

namespace faultsim {
namespace {

using Eigen::VectorXd;

LinearMap exact_schur(const SaddlePoint& j) {
  const LinearMap leading = direct_solver(j.leading(), j.symmetric);
  Eigen::MatrixXd s(j.n_multipliers(), j.n_multipliers());
  VectorXd column;
  for (int k = 0; k < j.n_multipliers(); ++k) {
    leading(j.coupling.col(k), column);
    s.col(k) = j.constraint.transpose() * column;
  }
  GrowingLu<double> lu;
  if (!lu.factor(s)) throw ResourceError("the Schur complement is singular");
  return [lu = std::move(lu)](const VectorXd& r, VectorXd& z) {
    z = r;
    lu.solve(z);
  };
}

LinearMap fsai_direct_schur(const SaddlePoint& j, const FsaiOptions& fsai) {
  const SparseMatrix g = fsai_factor(*j.symmetric_leading(), fsai);
  const SparseMatrix gc = g * j.constraint;
  const SparseMatrix right = j.symmetric ? gc : SparseMatrix(g * j.coupling);
  return direct_solver(SparseMatrix(gc.transpose()) * right, j.symmetric);
}

/// FSAI needs symmetry, so F is left out of what the second one approximates.
LinearMap fsai_fsai_schur(const SaddlePoint& j, const FsaiOptions& fsai) {
  const SparseMatrix gc = fsai_factor(*j.symmetric_leading(), fsai) * j.constraint;
  const SparseMatrix g = fsai_factor(SparseMatrix(gc.transpose()) * gc, fsai);
  return [g](const VectorXd& r, VectorXd& z) { z = g.transpose() * (g * r); };
}

/// The restriction of K + E to the dofs of the cells that share a node: they are the rows of its
/// columns. `place` (by dof: place in the list, −1 outside) is workspace.
struct LocalStiffness {
  LocalStiffness(const SaddlePoint& j, int first, int last, std::vector<int>& place) {
    for (int k = first; k < last; ++k) {
      for (SparseMatrix::InnerIterator c(j.constraint, k); c; ++c) {
        for (SparseMatrix::InnerIterator it(j.leading(), c.row()); it; ++it) {
          if (place[it.row()] >= 0) continue;
          place[it.row()] = static_cast<int>(dofs.size());
          dofs.push_back(static_cast<int>(it.row()));
        }
      }
    }
    matrix.setZero(dofs.size(), dofs.size());
    for (int column = 0; column < static_cast<int>(dofs.size()); ++column) {
      for (SparseMatrix::InnerIterator it(j.leading(), dofs[column]); it; ++it) {
        if (place[it.row()] >= 0) matrix(place[it.row()], column) = it.value();
      }
    }
  }
  /// Columns first … last−1 of c in the local dofs.
  Eigen::MatrixXd columns(const SparseMatrix& c, int first, int last,
                          const std::vector<int>& place) const {
    Eigen::MatrixXd local = Eigen::MatrixXd::Zero(matrix.rows(), last - first);
    for (int k = first; k < last; ++k) {
      for (SparseMatrix::InnerIterator it(c, k); it; ++it)
        local(place[it.row()], k - first) = it.value();
    }
    return local;
  }

  std::vector<int> dofs;
  Eigen::MatrixXd matrix;
};

LinearMap block_diagonal_schur(const SaddlePoint& j) {
  const std::vector<int>& begin = j.node_begin;
  std::vector<Eigen::MatrixXd> inverse;
  std::vector<int> place(j.n_displacements(), -1);
  for (int node = 0; node + 1 < static_cast<int>(begin.size()); ++node) {
    const int first = begin[node], last = begin[node + 1];
    const LocalStiffness local(j, first, last, place);
    inverse.emplace_back();
    if (last > first) {
      const Eigen::MatrixXd c = local.columns(j.constraint, first, last, place);
      const Eigen::MatrixXd s = c.transpose() * local.matrix.partialPivLu().solve(
                                                    local.columns(j.coupling, first, last, place));
      const Eigen::FullPivLU<Eigen::MatrixXd> lu(s);
      if (!lu.isInvertible()) throw ResourceError("a block of the Schur complement is singular");
      inverse.back() = lu.inverse();
    }
    for (const int dof : local.dofs) place[dof] = -1;
  }
  return [begin, inverse = std::move(inverse)](const VectorXd& r, VectorXd& z) {
    z.resize(r.size());
    for (std::size_t node = 0; node < inverse.size(); ++node) {
      const int first = begin[node], n = begin[node + 1] - first;
      if (n > 0) z.segment(first, n) = inverse[node] * r.segment(first, n);
    }
  };
}

/// The matrix amid it is applied, not formed: what it holds is K's.
LinearMap least_squares_commutator(const SaddlePoint& j) {
  return [&j, inverse_gram = VectorXd(j.gram().cwiseInverse())](const VectorXd& r, VectorXd& z) {
    const VectorXd scaled = inverse_gram.cwiseProduct(r);
    const VectorXd forces = j.times_leading(j.coupling * scaled);
    z = inverse_gram.cwiseProduct(j.constraint.transpose() * forces);
  };
}

}  // namespace

LinearMap schur_complement(SchurKind kind, const SaddlePoint& j, const FsaiOptions& fsai) {
  switch (kind) {
    case SchurKind::exact:
      return exact_schur(j);
    case SchurKind::fsai_direct:
      return fsai_direct_schur(j, fsai);
    case SchurKind::fsai_fsai:
      return fsai_fsai_schur(j, fsai);
    case SchurKind::bds:
      return block_diagonal_schur(j);
    case SchurKind::lsc:
      return least_squares_commutator(j);
    case SchurKind::rac:
      break;
  }
  FAULTSIM_DEMAND(false, "Schur complement ", static_cast<int>(kind));
}

}  // namespace faultsim
