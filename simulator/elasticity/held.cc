#include "simulator/elasticity/held.h"

#include <algorithm>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {
namespace {

std::string rounded(double value) {
  return formatted("%.7g", value == 0 ? 0.0 : value);  // no -0
}

}  // namespace

std::string extent_text(const Mesh& mesh, const std::function<bool(int)>& member) {
  const Eigen::AlignedBox3d extent = extent_of(mesh, member);
  int n_cells = 0;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    n_cells += member(mesh.cells[cell][0]) ? 1 : 0;
  std::string text = "the block ";
  for (int c = 0; c < 3; ++c) {
    text += concat(c == 0 ? "" : ", ", "xyz"[c], " ", rounded(extent.min()[c]), " to ",
                   rounded(extent.max()[c]), " m");
  }
  return text + concat(" (", n_cells, n_cells == 1 ? " cell)" : " cells)");
}

void throw_loose(const std::string& what) {
  throw InputError(
      "scene",
      {{"/geometry/boundary", 0, what,
        "fix displacement components on a side that the block touches (a roller or "
        "\"displacement\"), or prescribe no displacement anywhere: the body is then pinned at "
        "three points"}});
}

void require_held(const Mesh& mesh, const DofMap& dofs) {
  if (dofs.n_unknowns() == 0) {
    throw InputError("scene", {{"/geometry/boundary", 0,
                                "the displacement of every node is prescribed: nothing is left to "
                                "compute",
                                "free a side or a component, or use smaller cells"}});
  }
  const Pieces pieces = find_pieces(mesh);
  const auto is_fixed = [&](int node, int c) { return dofs.terms(node, c).empty(); };
  for (int body = 0; body < pieces.n_bodies; ++body) {
    const auto member = [&](int node) { return pieces.body[pieces.of_node[node]] == body; };
    const std::string freedom = describe(rigid_modes(mesh, member, is_fixed));
    if (!freedom.empty()) throw_loose(extent_text(mesh, member) + " can " + freedom);
  }
}

}  // namespace faultsim
