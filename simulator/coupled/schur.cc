#include "simulator/coupled/schur.h"

#include <Eigen/LU>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/linalg/dense_lu.h"

namespace faultsim {
namespace {

class ExactSchur final : public SchurComplement {
 public:
  explicit ExactSchur(const SaddlePoint& j) {
    DirectSolver leading(j.leading, j.symmetric);
    Eigen::MatrixXd s(j.n_multipliers(), j.n_multipliers());
    for (int k = 0; k < j.n_multipliers(); ++k) {
      s.col(k) = j.constraint.transpose() * leading.solve(j.coupling.col(k));
    }
    if (!lu_.factor(s)) throw ResourceError("the Schur complement is singular");
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    z = r;
    lu_.solve(z);
  }

 private:
  DenseLu lu_;
};

class FsaiDirectSchur final : public SchurComplement {
 public:
  FsaiDirectSchur(const SaddlePoint& j, const FsaiOptions& fsai) {
    const SparseMatrix g = fsai_factor(j.symmetric_leading(), fsai);
    const SparseMatrix gc = g * j.constraint;
    SparseMatrix s;
    if (j.symmetric) {
      s = SparseMatrix(gc.transpose()) * gc;
    } else {
      s = SparseMatrix(gc.transpose()) * SparseMatrix(g * j.coupling);
    }
    solver_ = std::make_unique<DirectSolver>(s, j.symmetric);
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override { z = solver_->solve(r); }

 private:
  std::unique_ptr<DirectSolver> solver_;
};

/// FSAI needs symmetry, so F is left out of what the second one approximates.
class FsaiFsaiSchur final : public SchurComplement {
 public:
  FsaiFsaiSchur(const SaddlePoint& j, const FsaiOptions& fsai) {
    const SparseMatrix gc = fsai_factor(j.symmetric_leading(), fsai) * j.constraint;
    factor_ = fsai_factor(SparseMatrix(gc.transpose()) * gc, fsai);
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    z = factor_.transpose() * (factor_ * r);
  }

 private:
  SparseMatrix factor_;
};

/// The restriction of K + E to the dofs of the cells that share a node: they are the rows of its
/// columns. `place` (by dof: place in the list, −1 outside) is workspace.
struct LocalStiffness {
  LocalStiffness(const SaddlePoint& j, int first, int last, std::vector<int>& place) {
    for (int k = first; k < last; ++k) {
      for (SparseMatrix::InnerIterator c(j.constraint, k); c; ++c) {
        for (SparseMatrix::InnerIterator it(j.leading, c.row()); it; ++it) {
          if (place[it.row()] >= 0) continue;
          place[it.row()] = static_cast<int>(dofs.size());
          dofs.push_back(static_cast<int>(it.row()));
        }
      }
    }
    matrix.setZero(dofs.size(), dofs.size());
    for (int column = 0; column < static_cast<int>(dofs.size()); ++column) {
      for (SparseMatrix::InnerIterator it(j.leading, dofs[column]); it; ++it) {
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

class BlockDiagonalSchur final : public SchurComplement {
 public:
  explicit BlockDiagonalSchur(const SaddlePoint& j) : begin_(j.node_begin) {
    std::vector<int> place(j.n_displacements(), -1);
    for (int node = 0; node + 1 < static_cast<int>(begin_.size()); ++node) {
      const int first = begin_[node], last = begin_[node + 1];
      const LocalStiffness local(j, first, last, place);
      if (last > first) {
        const Eigen::MatrixXd c = local.columns(j.constraint, first, last, place);
        const Eigen::MatrixXd s = c.transpose() * local.matrix.partialPivLu().solve(local.columns(
                                                      j.coupling, first, last, place));
        const Eigen::FullPivLU<Eigen::MatrixXd> lu(s);
        if (!lu.isInvertible()) throw ResourceError("a block of the Schur complement is singular");
        inverse_.push_back(lu.inverse());
      } else {
        inverse_.emplace_back();
      }
      for (const int dof : local.dofs) place[dof] = -1;
    }
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    z.resize(r.size());
    for (int node = 0; node + 1 < static_cast<int>(begin_.size()); ++node) {
      const int first = begin_[node], n = begin_[node + 1] - first;
      if (n > 0) z.segment(first, n) = inverse_[node] * r.segment(first, n);
    }
  }

 private:
  std::vector<int> begin_;
  std::vector<Eigen::MatrixXd> inverse_;
};

class LeastSquaresCommutator final : public SchurComplement {
 public:
  explicit LeastSquaresCommutator(const SaddlePoint& j) {
    const Eigen::VectorXd inverse_gram = j.gram().cwiseInverse();
    const SparseMatrix product =
        SparseMatrix(j.constraint.transpose()) * SparseMatrix(j.leading * j.coupling);
    inverse_ = inverse_gram.asDiagonal() * product * inverse_gram.asDiagonal();
  }
  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override { z = inverse_ * r; }

 private:
  SparseMatrix inverse_;
};

}  // namespace

std::unique_ptr<SchurComplement> make_schur_complement(SchurKind kind, const SaddlePoint& j,
                                                       const FsaiOptions& fsai) {
  switch (kind) {
    case SchurKind::exact:
      return std::make_unique<ExactSchur>(j);
    case SchurKind::fsai_direct:
      return std::make_unique<FsaiDirectSchur>(j, fsai);
    case SchurKind::fsai_fsai:
      return std::make_unique<FsaiFsaiSchur>(j, fsai);
    case SchurKind::bds:
      return std::make_unique<BlockDiagonalSchur>(j);
    case SchurKind::lsc:
      return std::make_unique<LeastSquaresCommutator>(j);
    case SchurKind::rac:
      break;
  }
  FAULTSIM_DEMAND(false, "Schur complement ", static_cast<int>(kind));
}

}  // namespace faultsim
