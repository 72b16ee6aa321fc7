#include "simulator/coupled/hypre_blocks.h"

#include <_hypre_parcsr_ls.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/coupled/hypre_objects.h"
#include "simulator/coupled/kept_motions.h"

namespace faultsim {
namespace {

using Call = HYPRE_Int (*)(HYPRE_Solver, HYPRE_ParCSRMatrix, HYPRE_ParVector, HYPRE_ParVector);

/// A solver of hypre's, applied once from zero.
struct HypreBlock {
  HypreBlock(std::shared_ptr<HypreMatrix> a, HYPRE_Int (*free)(HYPRE_Solver))
      : matrix(std::move(a)),
        r(matrix->ranges(), matrix->ranks()),
        z(matrix->ranges(), matrix->ranks()),
        destroy(free) {}
  ~HypreBlock() { destroy(solver); }
  HypreBlock(const HypreBlock&) = delete;
  HypreBlock& operator=(const HypreBlock&) = delete;

  void call(Call function, const char* doing) {
    function(solver, matrix->get(), r.get(), z.get());
    check_hypre(doing);
  }

  std::shared_ptr<HypreMatrix> matrix;
  HypreVector r, z;
  HYPRE_Int (*destroy)(HYPRE_Solver);
  HYPRE_Solver solver = nullptr;
  std::vector<std::unique_ptr<HypreVector>> rotations;  ///< to be kept as long as the solver.
  std::vector<HYPRE_ParVector> pointers;                ///< to them.
};

LinearMap set_up(const std::shared_ptr<HypreBlock>& block, Call set_up, Call solve) {
  block->call(set_up, "setting up a preconditioner");
  return [block, solve](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    block->r.values() = r;
    block->z.values().setZero();
    block->call(solve, "applying a preconditioner");
    z = block->z.values();
  };
}

/// What both kinds of AMG share.
std::shared_ptr<HypreBlock> amg_block(std::shared_ptr<HypreMatrix> a) {
  const auto block = std::make_shared<HypreBlock>(std::move(a), HYPRE_BoomerAMGDestroy);
  HYPRE_BoomerAMGCreate(&block->solver);
  HYPRE_Solver solver = block->solver;
  HYPRE_BoomerAMGSetNumFunctions(solver, 3);  // unknown i is of component i mod 3
  HYPRE_BoomerAMGSetCoarsenType(solver, 10);  // HMIS
  HYPRE_BoomerAMGSetInterpType(solver, 6);    // extended+i
  HYPRE_BoomerAMGSetPMaxElmts(solver, 4);
  HYPRE_BoomerAMGSetRelaxType(solver, 6);  // symmetric Gauss-Seidel: SPD
  // Solved as they are: on levels with fewer rows interpolation is too poor for rigid motions, and
  // a body held at three nodes takes up to twice the iterations.
  HYPRE_BoomerAMGSetMaxCoarseSize(solver, 300);
  HYPRE_BoomerAMGSetTol(solver, 0.0);
  HYPRE_BoomerAMGSetMaxIter(solver, 1);
  return block;
}

/// Translations are what interpolation keeps anyway; an orthonormal set mixes the six, so those
/// three that complete the translations are taken: Gram and Schmidt on the products of all with
/// each other, which ranks add up once.
std::vector<Eigen::VectorXd> rotations_of(const Eigen::MatrixXd& motions, const RowRanges& ranges,
                                          const Ranks& ranks) {
  const auto n = motions.rows();
  Eigen::MatrixXd all(n, 9);
  for (Eigen::Index i = 0; i < n; ++i)
    all.row(i).head<3>() =
        std::sqrt(3.0 / ranges.n_rows()) * Eigen::Vector3d::Unit(i % 3).transpose();
  all.rightCols<6>() = motions;
  Eigen::MatrixXd products = all.transpose() * all;
  ranks.sum(Eigen::Map<Eigen::VectorXd>(products.data(), products.size()));
  Eigen::MatrixXd taken = Eigen::MatrixXd::Identity(9, 3);  // as combinations of the nine
  std::vector<Eigen::VectorXd> rotations;
  for (int m = 3; m < 9 && rotations.size() < 3; ++m) {
    Eigen::VectorXd mode = Eigen::VectorXd::Unit(9, m);
    for (int pass = 0; pass < 2; ++pass) mode -= taken * (taken.transpose() * (products * mode));
    const double norm = std::sqrt(std::max(mode.dot(products * mode), 0.0));
    if (norm < 1e-6) continue;
    mode /= norm;
    taken.conservativeResize(Eigen::NoChange, taken.cols() + 1);
    taken.rightCols<1>() = mode;
    rotations.emplace_back(all * mode);
  }
  return rotations;
}

void set_rotations(const Eigen::MatrixXd& motions, HypreBlock& block) {
  const HypreMatrix& a = *block.matrix;
  for (const Eigen::VectorXd& mode : rotations_of(motions, a.ranges(), a.ranks())) {
    block.rotations.push_back(std::make_unique<HypreVector>(a.ranges(), a.ranks()));
    block.rotations.back()->values() = mode;
    block.pointers.push_back(block.rotations.back()->get());
  }
  const int found = static_cast<int>(block.pointers.size());
  HYPRE_BoomerAMGSetInterpVectors(block.solver, found, block.pointers.data());
  HYPRE_BoomerAMGSetInterpVecVariant(block.solver, 2);
  HYPRE_BoomerAMGSetInterpVecQMax(block.solver, 4);
  HYPRE_BoomerAMGSetSmoothInterpVectors(block.solver, 1);
}

}  // namespace

std::shared_ptr<HypreMatrix> hypre_matrix(const SparseMatrix& symmetric) {
  return std::make_shared<HypreMatrix>(symmetric);
}

LinearMap hypre_ilu(std::shared_ptr<HypreMatrix> a, const IluOptions& options) {
  const auto block = std::make_shared<HypreBlock>(std::move(a), HYPRE_ILUDestroy);
  HYPRE_ILUCreate(&block->solver);
  HYPRE_ILUSetType(block->solver, 1);  // ILUT on each rank's block
  HYPRE_ILUSetDropThreshold(block->solver, options.drop_tolerance);
  HYPRE_ILUSetMaxNnzPerRow(block->solver, options.max_row);
  HYPRE_ILUSetMaxIter(block->solver, 1);
  HYPRE_ILUSetTol(block->solver, 0.0);
  return set_up(block, HYPRE_ILUSetup, HYPRE_ILUSolve);
}

LinearMap hypre_amg(std::shared_ptr<HypreMatrix> a, const Eigen::MatrixXd& rigid_motions) {
  const auto block = amg_block(std::move(a));
  HYPRE_BoomerAMGSetNodal(block->solver, 4);  // strength of a node's 3 x 3 block: row sum
  HYPRE_BoomerAMGSetNodalDiag(block->solver, 1);
  // HMIS and a threshold of 1/4: with PMIS and 1/2, which hypre's manual has for three
  // dimensions, counts grow with each refinement, 13 to 18, and the hierarchy is no smaller.
  HYPRE_BoomerAMGSetStrongThreshold(block->solver, 0.25);
  set_rotations(rigid_motions, *block);
  return set_up(block, HYPRE_BoomerAMGSetup, HYPRE_BoomerAMGSolve);
}

LinearMap hypre_amg_by_component(std::shared_ptr<HypreMatrix> a,
                                 const Eigen::MatrixXd& rigid_motions) {
  const auto block = amg_block(std::move(a));
  HYPRE_BoomerAMGSetStrongThreshold(block->solver, kStrongByComponent);
  const LinearMap cycle = set_up(block, HYPRE_BoomerAMGSetup, HYPRE_BoomerAMGSolve);
  const auto multiply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    block->r.values() = x;
    HYPRE_ParCSRMatrixMatvec(1, block->matrix->get(), block->r.get(), 0, block->z.get());
    check_hypre("multiplying");
    y = block->z.values();
  };
  return with_motions_kept(cycle, multiply, rigid_motions, sum_over(block->matrix->ranks()));
}

}  // namespace faultsim
