#include "simulator/condensation/loose_pieces.h"

#include <algorithm>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/elasticity/held.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {
Eigen::VectorXd loose_piece_springs(const BulkProblem& problem, const DofMap& dofs,
                                    const FaultGeometry& geometry) {
  const Mesh& mesh = problem.mesh;
  require_held(mesh, dofs);
  const Pieces pieces = find_pieces(mesh);
  const auto piece_of = [&](int node) { return pieces.of_node[node]; };
  const auto is_fixed = [&](int node, int c) { return dofs.terms(node, c).empty(); };
  std::vector<bool> is_loose;
  for (int piece = 0; piece < pieces.n_pieces; ++piece) {
    const auto member = [&](int node) { return piece_of(node) == piece; };
    is_loose.push_back(rigid_modes(mesh, member, is_fixed).free.cols() > 0);
  }
  Eigen::VectorXd springs = Eigen::VectorXd::Zero(geometry.n_dofs);
  auto node = geometry.nodes.begin();  // skips the pairs that a boundary holds closed
  for (std::size_t f = 0; f < mesh.faults.size(); ++f) {
    const FaultSurface& fault = mesh.faults[f];
    for (std::size_t k = 0; k < fault.nodes.size(); ++k) {
      const auto jump = [&](int c) {
        return dofs.jump_dof(static_cast<int>(f), static_cast<int>(k), c);
      };
      if (jump(0) < 0 && jump(1) < 0 && jump(2) < 0) continue;
      const FaultNode& pair = fault.nodes[k];
      const bool holds_loose =
          is_loose[piece_of(pair.minus_node)] || is_loose[piece_of(pair.plus_node)];
      const double edge = std::max(node->edge_strike, node->edge_dip);
      for (int dof : node->dof) {
        if (holds_loose && dof >= 0) {
          springs[dof] = node->area * node->effective_shear_modulus / edge;
        }
      }
      ++node;
    }
  }
  FAULTSIM_DEMAND(node == geometry.nodes.end(), geometry.nodes.size(), " nodes");
  return springs;
}

void throw_not_held(const BulkProblem& problem, const DofMap& dofs, int unknown) {
  const Mesh& mesh = problem.mesh;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (!std::ranges::count(dofs.terms(static_cast<int>(i), c), unknown, &DofMap::Term::unknown))
        continue;
      const Pieces pieces = find_pieces(mesh);
      const int piece = pieces.of_node[i];
      const auto member = [&](int node) { return pieces.of_node[node] == piece; };
      const Eigen::Vector3d at = mesh.nodes[i].array() + 0.0;  // no -0
      throw_loose(formatted("the stiffness matrix is singular at x %.7g, y %.7g, z %.7g m: ",
                            at.x(), at.y(), at.z()) +
                  extent_text(mesh, member) + " is not held well enough");
    }
  }
  FAULTSIM_DEMAND(false, "unknown ", unknown, " belongs to no node");
  std::abort();
}

}  // namespace faultsim
