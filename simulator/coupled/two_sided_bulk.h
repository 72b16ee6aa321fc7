#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "simulator/coupled/engine_matrix.h"
#include "simulator/coupled/free_copies.h"
#include "simulator/coupled/ranks.h"
#include "simulator/elasticity/bulk_problem.h"

namespace faultsim {

/// A displacement in a jump.
struct JumpTerm {
  std::array<int, 3> dof;  ///< of x, y, z; −1 = prescribed.
  double factor;           ///< of two copies −1 on the minus side, 1 on the plus side.
};

/// A node of a fault as the coupled path sees it: R_k g_k = Σ factor u.
struct TwoSidedNode {
  std::vector<JumpTerm> terms;  ///< of distinct nodes; none where it stays closed.
  Eigen::Matrix3d frame;        ///< R_k: columns n, strike, dip.
  double area;                  ///< A_k, m2.
  std::array<int, 3> jump;      ///< n, strike and dip as dofs of the operator that condensation
                                ///< makes; −1 = stays closed.
  int owner;                    ///< the rank that has the rows of all its terms.
  bool may_jump(int c) const { return jump[c] >= 0; }
};

/// Pieces of rock that only faults hold: K is singular then.
enum class LoosePieces {
  refused,
  held_by_faults  ///< the solver sees to that (SchurKind::rac).
};

/// The linear bulk over displacements of both sides of every fault (model section 11):
/// K (n_u x n_u), unit loads, and where the fault nodes are in it.
///
/// Dofs are 3 i + c for component c of the i-th node that moves by itself (FreeCopies), those of
/// rank 0 first. All ranks know the mesh and the numbers of all dofs; of K and of vectors over dofs
/// each has its own rows, all copies at one place among them.
/// Prescribed displacements stay dofs: their rows and columns of K are those of the identity times
/// the mean diagonal, so that every node has three dofs, which algebraic multigrid wants. Fault
/// nodes that the condensed path keeps closed (DofMap) are tied here.
class TwoSidedBulk {
 public:
  /// Throws InputError when nothing holds a body, or a piece that faults cut loose where those are
  /// refused. Collective.
  explicit TwoSidedBulk(const BulkProblem& problem, LoosePieces loose = LoosePieces::refused,
                        const Ranks& ranks = {});

  const Ranks& ranks() const { return ranks_; }
  const RowRanges& ranges() const { return ranges_; }
  int n_displacements() const { return ranges_.n_rows(); }  ///< n_u, of all ranks.
  int first_own() const { return ranges_.first(ranks_); }
  int n_own() const { return ranges_.count(ranks_); }
  /// K, both triangles, sorted columns, for what needs the matrix whole: on one rank only
  /// (InternalError).
  const SparseMatrix& stiffness() const;
  /// K in the solver's format, which from now on is the only copy, until somebody asks for
  /// stiffness(). Collective.
  EngineMatrix& engine() const;
  bool has_engine() const { return engine_ != nullptr; }
  /// K u and the diagonal of K, own rows, by whichever of both is there. Collective.
  Eigen::VectorXd times_stiffness(const Eigen::VectorXd& u) const;
  Eigen::VectorXd diagonal() const;

  long n_entries() const { return n_entries_; }  ///< of own rows of K.

  int n_loads() const { return static_cast<int>(problem_.loads.size()); }
  /// Right-hand side of unit load k, own rows: nodal forces, and in prescribed rows mean diagonal
  /// times the prescribed displacement.
  Eigen::VectorXd load(int k) const;
  const std::vector<TwoSidedNode>& fault_nodes() const { return fault_nodes_; }
  bool owns(const TwoSidedNode& node) const { return node.owner == ranks_.rank(); }
  /// Dof of component c of a mesh node, prescribed ones included; −1 where other nodes move it.
  int dof(int node, int component) const {
    const int rank = rank_[problem_.mesh.tied_to[node]];
    return rank < 0 ? -1 : 3 * rank + component;
  }
  /// Of all mesh nodes, 3 x n_nodes, from the own displacement dofs. Collective.
  Eigen::Matrix3Xd nodal_displacement(const Eigen::VectorXd& u) const;
  bool is_prescribed(int dof) const { return prescribed_[dof]; }
  /// Displacements of the six rigid motions, orthonormal over all dofs, own rows x 6; prescribed
  /// dofs move with them. Collective.
  Eigen::MatrixXd rigid_motions() const;

 private:
  template <typename Visit>
  void for_each_free_node(const Visit& visit) const {
    for (int i = 0; i < static_cast<int>(rank_.size()); ++i)
      if (rank_[i] >= 0) visit(i);
  }
  struct Term {
    int dof;
    double factor;
  };
  std::span<const Term> terms(int unknown) const {
    return {terms_.data() + term_begin_[unknown], terms_.data() + term_begin_[unknown + 1]};
  }
  void require_pieces_held() const;
  void number_dofs();
  std::vector<int> owners() const;
  void find_terms();
  std::vector<char> cells_of_own_rows() const;
  SparseMatrix lower_of_own() const;
  void find_mean_diagonal(const SparseMatrix& lower);
  SparseMatrix own_rows(SparseMatrix lower) const;
  SparseMatrix moved_by_dofs(bool only_own) const;
  SparseMatrix room_of_faults() const;
  void place_fault_nodes(const DofMap& condensed);

  BulkProblem problem_;  ///< without faults in its mesh: all copies of a node are independent.
  std::unique_ptr<FreeCopies> copies_;
  std::unique_ptr<DofMap> dofs_;
  std::vector<int> rank_;         ///< per mesh node: place among the free ones; −1 = none.
  std::vector<char> prescribed_;  ///< per dof.
  std::vector<int> term_begin_;   ///< per unknown of dofs_.
  std::vector<Term> terms_;
  Ranks ranks_;
  RowRanges ranges_;
  double mean_diagonal_ = 0;
  long n_entries_ = 0;
  mutable std::unique_ptr<const SparseMatrix> rows_;  ///< n_u x own: column k is row first + k.
  mutable std::unique_ptr<EngineMatrix> engine_;
  std::vector<TwoSidedNode> fault_nodes_;
};

}  // namespace faultsim
