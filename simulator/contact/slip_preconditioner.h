#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/contact/moving_block.h"
#include "simulator/contact/tangent_unknown.h"
#include "simulator/linalg/growing_lu.h"

namespace faultsim {

/// M ≈ T of tangent_solver.h, for GMRES. A node that slips is one unknown of M, its slip along its
/// direction d, which the law couples to all others through the normal traction:
///
///   M_pq = d_pᵀ T_pq d_q;   across d, where nodes hardly see each other, T of the node alone.
///
/// Half of the unknowns, an eighth of the factorisation. What opens, and what slips without
/// friction and so has no direction, has each of its components in M. The factor, in single
/// precision, outlives the iteration that it was made for: it grows by those who begin to move, as
/// their equations are then, and passes over those who come to rest.
class SlipPreconditioner {
 public:
  /// @pre block outlives this, and holds all that the unknowns need of H.
  SlipPreconditioner(int n_dofs, const MovingBlock& block);

  void clear();
  /// Unknowns of M; after clear() none.
  int size() const { return factor_.size(); }
  /// Takes the unknowns of the next tangent. @returns false when M is singular; it is clear then.
  bool cover(const std::vector<TangentUnknown>& unknowns);
  /// y := M⁻¹ x over the unknowns covered last. x in Pa, y in m.
  void apply(const Eigen::VectorXd& x, Eigen::VectorXd& y);

 private:
  /// One or both shear components of a node, or one component that opens: where they begin in the
  /// unknowns, d, and T across d.
  struct Mover {
    int node, dof, first, n;
    Eigen::Vector2d along;
    double across;
  };
  /// A row and column of M, as it was when it joined.
  struct Joined {
    int dof, place;          ///< of its first component; where its node is in the block.
    Eigen::Vector3f motion;  ///< d in the dofs of its node.
    Eigen::Vector3f weight;  ///< dᵀ of the components' weights.
    float own;               ///< dᵀ (∂R/∂Δg_T) d, Pa/m.
  };
  void find_movers(const std::vector<TangentUnknown>& unknowns);
  double own_across(const std::vector<TangentUnknown>& unknowns, const Mover& mover) const;
  Joined join(const std::vector<TangentUnknown>& unknowns, const Mover& mover) const;
  void fill(GrowingLu<float>::Block& m, int q, int first);

  const MovingBlock& block_;
  GrowingLu<float> factor_;
  std::vector<Joined> joined_;
  std::vector<int> place_;     ///< in the factor, per dof of the operator; −1: not there.
  std::vector<Mover> movers_;  ///< of the unknowns covered last.
  Eigen::VectorXf side_, at_motion_, at_weight_;
};

}  // namespace faultsim
