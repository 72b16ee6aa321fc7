#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "simulator/common/disjoint_sets.h"
#include "simulator/mesh/mesh.h"

namespace faultsim {

/// A share of a node's displacement, the same for all three components.
struct NodeTerm {
  int node;  ///< of the mesh.
  double factor;
};
using NodeTerms = std::vector<NodeTerm>;

/// What faults make of displacements when the copies of a node move by themselves instead of by
/// their mean and jumps: at each place the inverse of u_s = ū + Σ_j weight_sj d_j (NodeCopy,
/// d = R g),
///
///   d_j = Σ_s factor_js u_s.
///
/// Copies at the corners of cells are free. A place in the middle of a side of tetrahedra has no
/// jump of its own: its first copy is free, and the others move with it and with the corners'
/// copies.
class FreeCopies {
 public:
  using MayJump = std::function<bool(int fault, int node)>;
  /// Copies at one place, and the jumps that are between them.
  struct Place {
    std::vector<const NodeCopy*> copies;
    std::vector<std::pair<int, int>> jumps;  ///< fault and node.
  };

  /// Takes faults and copies out of the mesh; copies that nothing moves apart are tied there.
  /// @param may_jump  of a node of a fault; whether any component of its jump is free.
  /// Throws InputError about "/geometry/boundary" where a jump that a condition closes leaves
  /// others at its place open that no tie expresses.
  FreeCopies(Mesh& mesh, const MayJump& may_jump);

  const std::vector<FaultSurface>& faults() const { return faults_; }
  /// d of a node of a fault; without terms where it may not jump.
  const NodeTerms& jump(int fault, int node) const { return jumps_[fault][node]; }
  /// A node that is not tied, by free ones; of a free one itself, of others the first copy at their
  /// place before the corners.
  NodeTerms displacement(int node) const;
  bool is_free(int node) const { return moved_[node].empty(); }

 private:
  void free_corners(Place place, const Mesh& mesh, const MayJump& may_jump, DisjointSets& ties);
  void move_amid(const Place& place, DisjointSets& ties);

  std::vector<FaultSurface> faults_;
  std::vector<std::vector<NodeTerms>> jumps_;  // per fault and node
  std::vector<NodeTerms> moved_;               // per mesh node; empty = free
};

}  // namespace faultsim
