#include "simulator/condensation/loose_pieces.h"

#include <algorithm>
#include <functional>
#include <iomanip>
#include <limits>
#include <sstream>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {
namespace {

constexpr const char* kCure =
    "fix displacement components on a side that the block touches (a roller or \"displacement\"), "
    "or prescribe no displacement anywhere: the body is then pinned at three points";

std::string rounded(double value) {
  std::ostringstream text;
  text << std::setprecision(7) << (value == 0 ? 0.0 : value);  // no -0
  return text.str();
}

/// "the block x 0 to 10 m, y 0 to 10 m, z -5 to 0 m (12 cells)".
std::string extent(const Mesh& mesh, const std::function<bool(int)>& member) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (!member(static_cast<int>(i))) continue;
    low = low.cwiseMin(mesh.nodes[i]);
    high = high.cwiseMax(mesh.nodes[i]);
  }
  const auto n_cells = std::count_if(mesh.cells.begin(), mesh.cells.end(),
                                     [&](const auto& cell) { return member(cell[0]); });
  std::string text = "the block ";
  for (int c = 0; c < 3; ++c) {
    text +=
        concat(c == 0 ? "" : ", ", "xyz"[c], " ", rounded(low[c]), " to ", rounded(high[c]), " m");
  }
  return text + concat(" (", n_cells, n_cells == 1 ? " cell)" : " cells)");
}

[[noreturn]] void throw_loose(const std::string& what) {
  throw InputError("scene", {{"/geometry/boundary", 0, what, kCure}});
}

}  // namespace

Eigen::VectorXd loose_piece_springs(const BulkProblem& problem, const DofMap& dofs,
                                    const FaultGeometry& geometry) {
  const Mesh& mesh = problem.mesh;
  const Pieces pieces = find_pieces(mesh);
  const auto piece_of = [&](int node) { return pieces.of_node[static_cast<std::size_t>(node)]; };
  const auto is_fixed = [&](int node, int c) {
    const auto [first, last] = dofs.terms(node, c);
    return first == last;
  };
  for (int body = 0; body < pieces.n_bodies; ++body) {
    const auto member = [&](int node) {
      return pieces.body[static_cast<std::size_t>(piece_of(node))] == body;
    };
    const std::string freedom = describe(rigid_modes(mesh, member, is_fixed));
    if (!freedom.empty()) throw_loose(extent(mesh, member) + " can " + freedom);
  }
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
      const bool holds_loose = is_loose[static_cast<std::size_t>(piece_of(pair.minus_node))] ||
                               is_loose[static_cast<std::size_t>(piece_of(pair.plus_node))];
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
      const auto [first, last] = dofs.terms(static_cast<int>(i), c);
      const bool is_here = std::any_of(
          first, last, [&](const DofMap::Term& term) { return term.unknown == unknown; });
      if (!is_here) continue;
      const Pieces pieces = find_pieces(mesh);
      const int piece = pieces.of_node[i];
      const auto member = [&](int node) {
        return pieces.of_node[static_cast<std::size_t>(node)] == piece;
      };
      throw_loose(concat("the stiffness matrix is singular at x ", rounded(mesh.nodes[i].x()),
                         ", y ", rounded(mesh.nodes[i].y()), ", z ", rounded(mesh.nodes[i].z()),
                         " m: ", extent(mesh, member), " is not held well enough"));
    }
  }
  FAULTSIM_DEMAND(false, "unknown ", unknown, " belongs to no node");
  std::abort();
}

}  // namespace faultsim
