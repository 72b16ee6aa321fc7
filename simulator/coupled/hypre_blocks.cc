#include "simulator/coupled/hypre_blocks.h"

#include <_hypre_parcsr_ls.h>

#include <functional>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/coupled/hypre_objects.h"

namespace faultsim {
namespace {

using Call = HYPRE_Int (*)(HYPRE_Solver, HYPRE_ParCSRMatrix, HYPRE_ParVector, HYPRE_ParVector);

/// A solver of hypre's, applied once from zero.
class HypreBlock : public LeadingBlock {
 public:
  HypreBlock(const SparseMatrix& a, Call solve)
      : matrix_(a), r_(static_cast<int>(a.rows())), z_(static_cast<int>(a.rows())), solve_(solve) {}

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) override {
    r_.values() = r;
    z_.values().setZero();
    solve_(solver_, matrix_.get(), r_.get(), z_.get());
    check_hypre("applying a preconditioner");
    z = z_.values();
  }

 protected:
  void set_up(Call call) {
    call(solver_, matrix_.get(), r_.get(), z_.get());
    check_hypre("setting up a preconditioner");
  }
  HYPRE_Solver solver_ = nullptr;

 private:
  HypreMatrix matrix_;
  HypreVector r_, z_;
  Call solve_;
};

class IluBlock final : public HypreBlock {
 public:
  IluBlock(const SparseMatrix& a, const IluOptions& options) : HypreBlock(a, HYPRE_ILUSolve) {
    HYPRE_ILUCreate(&solver_);
    HYPRE_ILUSetType(solver_, 1);  // ILUT on each rank's block
    HYPRE_ILUSetDropThreshold(solver_, options.drop_tolerance);
    HYPRE_ILUSetMaxNnzPerRow(solver_, options.max_row);
    HYPRE_ILUSetMaxIter(solver_, 1);
    HYPRE_ILUSetTol(solver_, 0.0);
    set_up(HYPRE_ILUSetup);
  }
  ~IluBlock() override { HYPRE_ILUDestroy(solver_); }
};

/// What both kinds of AMG share.
void set_common(HYPRE_Solver solver) {
  HYPRE_BoomerAMGSetNumFunctions(solver, 3);  // unknown i is of component i mod 3
  HYPRE_BoomerAMGSetCoarsenType(solver, 10);  // HMIS
  HYPRE_BoomerAMGSetInterpType(solver, 6);    // extended+i
  HYPRE_BoomerAMGSetPMaxElmts(solver, 4);
  HYPRE_BoomerAMGSetRelaxType(solver, 6);  // symmetric Gauss-Seidel: SPD
  HYPRE_BoomerAMGSetTol(solver, 0.0);
  HYPRE_BoomerAMGSetMaxIter(solver, 1);
}

class ComponentAmgBlock final : public HypreBlock {
 public:
  explicit ComponentAmgBlock(const SparseMatrix& a) : HypreBlock(a, HYPRE_BoomerAMGSolve) {
    HYPRE_BoomerAMGCreate(&solver_);
    set_common(solver_);
    HYPRE_BoomerAMGSetStrongThreshold(solver_, 0.9);
    set_up(HYPRE_BoomerAMGSetup);
  }
  ~ComponentAmgBlock() override { HYPRE_BoomerAMGDestroy(solver_); }
};

class AmgBlock final : public HypreBlock {
 public:
  AmgBlock(const SparseMatrix& a, const Eigen::MatrixXd& motions)
      : HypreBlock(a, HYPRE_BoomerAMGSolve) {
    HYPRE_BoomerAMGCreate(&solver_);
    set_common(solver_);
    HYPRE_BoomerAMGSetNodal(solver_, 4);  // strength of a node's 3 x 3 block: row sum
    HYPRE_BoomerAMGSetNodalDiag(solver_, 1);
    // HMIS and a threshold of 1/4: with PMIS and 1/2, which hypre's manual has for three
    // dimensions, counts grow with each refinement, 13 to 18, and the hierarchy is no smaller.
    HYPRE_BoomerAMGSetStrongThreshold(solver_, 0.25);
    set_rotations(motions);
    set_up(HYPRE_BoomerAMGSetup);
  }
  ~AmgBlock() override { HYPRE_BoomerAMGDestroy(solver_); }

 private:
  /// Translations are what interpolation keeps anyway; an orthonormal set mixes the six, so those
  /// three that complete the translations are taken.
  void set_rotations(const Eigen::MatrixXd& motions) {
    const int n = static_cast<int>(motions.rows());
    Eigen::MatrixXd all(n, 9);
    for (int i = 0; i < n; ++i) all.row(i).head<3>() = Eigen::Vector3d::Unit(i % 3).transpose();
    all.rightCols<6>() = motions;
    int found = 0;
    for (int m = 3; m < 9 && found < 3; ++m) {  // Gram-Schmidt against what is there
      Eigen::VectorXd mode = all.col(m);
      for (int pass = 0; pass < 2; ++pass) {
        for (int c = 0; c < 3; ++c) mode -= 3.0 / n * all.col(c).dot(mode) * all.col(c);
        for (const auto& other : rotations_) mode -= other->values().dot(mode) * other->values();
      }
      if (mode.norm() < 1e-6) continue;
      rotations_.push_back(std::make_unique<HypreVector>(n));
      rotations_.back()->values() = mode.normalized();
      pointers_.push_back(rotations_.back()->get());
      ++found;
    }
    HYPRE_BoomerAMGSetInterpVectors(solver_, found, pointers_.data());
    HYPRE_BoomerAMGSetInterpVecVariant(solver_, 2);
    HYPRE_BoomerAMGSetInterpVecQMax(solver_, 4);
    HYPRE_BoomerAMGSetSmoothInterpVectors(solver_, 1);
  }
  std::vector<std::unique_ptr<HypreVector>> rotations_;
  std::vector<HYPRE_ParVector> pointers_;
};

}  // namespace

std::unique_ptr<LeadingBlock> make_hypre_ilu(const SparseMatrix& a, const IluOptions& options) {
  return std::make_unique<IluBlock>(a, options);
}
std::unique_ptr<LeadingBlock> make_hypre_amg(const SparseMatrix& a,
                                             const Eigen::MatrixXd& rigid_motions) {
  return std::make_unique<AmgBlock>(a, rigid_motions);
}

std::unique_ptr<LeadingBlock> make_hypre_amg_by_component(const SparseMatrix& a) {
  return std::make_unique<ComponentAmgBlock>(a);
}

}  // namespace faultsim
