#include "simulator/coupled/two_sided_bulk.h"

#include <Eigen/QR>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/elasticity/held.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {
namespace {

/// Ties the sides of the nodes at which the condensed path allows no jump at all.
void tie_closed_nodes(const DofMap& condensed, const std::vector<FaultSurface>& faults,
                      Mesh& mesh) {
  if (mesh.tied_to.empty()) {
    mesh.tied_to.resize(mesh.nodes.size());
    std::iota(mesh.tied_to.begin(), mesh.tied_to.end(), 0);
  }
  for (int f = 0; f < static_cast<int>(faults.size()); ++f) {
    for (int k = 0; k < static_cast<int>(faults[f].nodes.size()); ++k) {
      if (condensed.jump_dof(f, k, 0) >= 0) continue;
      const FaultNode& node = faults[f].nodes[k];
      const int from = mesh.tied_to[node.plus_node], to = mesh.tied_to[node.minus_node];
      for (int& root : mesh.tied_to) {
        if (root == from) root = to;
      }
    }
  }
}

}  // namespace

TwoSidedBulk::TwoSidedBulk(const BulkProblem& problem, LoosePieces loose) : problem_(problem) {
  const int n_loads = static_cast<int>(problem.loads.size());
  const DofMap condensed(problem.mesh, problem.conditions, n_loads);
  require_held(problem.mesh, condensed);
  Mesh& mesh = problem_.mesh;
  FAULTSIM_DEMAND(mesh.cells.shape() == CellShape::hexahedron, "jumps that are tied at mid-sides");
  faults_.swap(mesh.faults);
  mesh.copies.clear();
  tie_closed_nodes(condensed, faults_, mesh);
  dofs_ = std::make_unique<DofMap>(mesh, problem.conditions, n_loads);
  if (loose == LoosePieces::refused) require_pieces_held();
  int n_independent = 0;
  rank_.resize(mesh.nodes.size());
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    if (mesh.tied_to[i] == i) rank_[i] = n_independent++;
  }
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) rank_[i] = rank_[mesh.tied_to[i]];
  assemble();
  place_fault_nodes(condensed);
}

int TwoSidedBulk::dof(int node, int component) const { return 3 * rank_[node] + component; }

/// Every piece must be held by itself: multipliers tie pieces together only in the whole system.
void TwoSidedBulk::require_pieces_held() const {
  const Pieces pieces = find_pieces(problem_.mesh);
  for (int piece = 0; piece < pieces.n_pieces; ++piece) {
    const RigidModes modes = rigid_modes(
        problem_.mesh, [&](int node) { return pieces.of_node[node] == piece; },
        [&](int node, int c) { return dofs_->terms(node, c).empty(); });
    if (modes.free.cols() == 0) continue;
    throw InputError(
        "coupled path",
        {{"/boundary", 0,
          concat("a piece of ", pieces.n_cells[piece], " cells that the faults cut loose can ",
                 describe(modes)),
          "hold it by a boundary condition, take rac as its Schur complement, or use the "
          "condensed path"}});
  }
}

/// K of the free dofs, spread over all dofs, with both triangles and identity rows.
void TwoSidedBulk::assemble() {
  const Mesh& mesh = problem_.mesh;
  const int n_u = 3 * (1 + *std::ranges::max_element(rank_));
  std::vector<int> dof_of(dofs_->n_unknowns());
  prescribed_.assign(n_u, 1);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    for (int c = 0; c < 3; ++c) {
      for (const DofMap::Term& term : dofs_->terms(i, c)) {
        dof_of[term.unknown] = dof(i, c);
        prescribed_[dof(i, c)] = 0;
      }
    }
  }
  const SparseMatrix lower =
      assemble_stiffness(mesh, problem_.materials, *dofs_, problem_.mean_dilatation);
  mean_diagonal_ = lower.diagonal().mean();
  std::vector<Eigen::Triplet<double, long>> entries;
  entries.reserve(2 * lower.nonZeros() + n_u);
  for (int column = 0; column < lower.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator it(lower, column); it; ++it) {
      const int i = dof_of[it.row()], j = dof_of[column];
      entries.emplace_back(i, j, it.value());
      if (i != j) entries.emplace_back(j, i, it.value());
    }
  }
  for (int i = 0; i < n_u; ++i) {
    if (prescribed_[i]) entries.emplace_back(i, i, mean_diagonal_);
  }
  stiffness_.resize(n_u, n_u);
  stiffness_.setFromTriplets(entries.begin(), entries.end());
}

void TwoSidedBulk::place_fault_nodes(const DofMap& condensed) {
  for (int f = 0; f < static_cast<int>(faults_.size()); ++f) {
    for (int k = 0; k < static_cast<int>(faults_[f].nodes.size()); ++k) {
      const FaultNode& node = faults_[f].nodes[k];
      TwoSidedNode two{};
      two.frame << node.normal, node.strike, node.dip;
      two.area = node.area;
      for (int c = 0; c < 3; ++c) {
        two.jump[c] = condensed.jump_dof(f, k, c);
        const int minus = dof(node.minus_node, c), plus = dof(node.plus_node, c);
        two.minus[c] = prescribed_[minus] ? -1 : minus;
        two.plus[c] = prescribed_[plus] ? -1 : plus;
      }
      fault_nodes_.push_back(two);
    }
  }
}

Eigen::VectorXd TwoSidedBulk::load(int k) const {
  const Eigen::VectorXd force = unit_load(problem_, *dofs_, k);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n_displacements());
  for (int i = 0; i < static_cast<int>(problem_.mesh.nodes.size()); ++i) {
    for (int c = 0; c < 3; ++c) {
      const auto terms = dofs_->terms(i, c);
      f[dof(i, c)] =
          terms.empty() ? mean_diagonal_ * dofs_->prescribed(k, i, c) : force[terms[0].unknown];
    }
  }
  return f;
}

Eigen::MatrixXd TwoSidedBulk::rigid_motions() const {
  const Mesh& mesh = problem_.mesh;
  const RigidModes modes = rigid_modes(
      mesh, [](int) { return true; }, [](int, int) { return false; });
  Eigen::MatrixXd motions(n_displacements(), 6);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    motions.middleRows(dof(i, 0), 3) = modes.at(mesh.nodes[i]);
  }
  return Eigen::HouseholderQR<Eigen::MatrixXd>(motions).householderQ() *
         Eigen::MatrixXd::Identity(n_displacements(), 6);
}

}  // namespace faultsim
