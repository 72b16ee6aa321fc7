#include "simulator/coupled/two_sided_bulk.h"

#include <Eigen/QR>
#include <algorithm>
#include <numeric>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/elasticity/held.h"
#include "simulator/elasticity/rigid_modes.h"

namespace faultsim {
namespace {

[[noreturn]] void refuse_half_held(const Eigen::Vector3d& x) {
  throw InputError("coupled path",
                   {{"/geometry/boundary", 0,
                     concat("at (", x.x(), ", ", x.y(), ", ", x.z(),
                            ") m a condition holds one side of a fault and not the other"),
                     "let it hold both sides, or take the condensed path"}});
}

/// A symmetric matrix of size n with row and column k of `lower` at place[k], ascending.
SparseMatrix both_triangles(const SparseMatrix& lower, const std::vector<int>& place, int n) {
  std::vector<long> next(1 + n, 0);
  const auto for_each_entry = [&](const auto& visit) {  // (row, column, value), columns ascending
    for (int column = 0; column < static_cast<int>(lower.cols()); ++column)
      for (SparseMatrix::InnerIterator it(lower, column); it; ++it)
        visit(place[it.row()], place[column], it.value());
  };
  for_each_entry([&](int i, int j, double) {
    ++next[1 + j];
    if (i != j) ++next[1 + i];
  });
  std::partial_sum(next.begin(), next.end(), next.begin());
  SparseMatrix whole(n, n);
  whole.resizeNonZeros(next.back());
  std::ranges::copy(next, whole.outerIndexPtr());
  const auto append = [&](int row, int column, double value) {
    const long at = next[column]++;
    whole.innerIndexPtr()[at] = row;
    whole.valuePtr()[at] = value;
  };
  for_each_entry([&](int i, int j, double value) {
    append(i, j, value);
    if (i != j) append(j, i, value);
  });
  return whole;
}

}  // namespace

TwoSidedBulk::TwoSidedBulk(const BulkProblem& problem, LoosePieces loose) : problem_(problem) {
  const int n_loads = static_cast<int>(problem.loads.size());
  const DofMap condensed(problem.mesh, problem.conditions, n_loads);
  require_held(problem.mesh, condensed);
  copies_ = std::make_unique<FreeCopies>(
      problem_.mesh, [&](int fault, int node) { return condensed.jump_dof(fault, node, 0) >= 0; });
  dofs_ = std::make_unique<DofMap>(problem_.mesh, problem.conditions, n_loads);
  if (loose == LoosePieces::refused) require_pieces_held();
  const std::vector<int>& tied_to = problem_.mesh.tied_to;
  int n_free = 0;
  for (int i = 0; i < static_cast<int>(tied_to.size()); ++i) {
    const bool is_free = tied_to[i] == i && copies_->is_free(i);
    rank_.push_back(is_free ? n_free++ : -1);
  }
  find_terms(3 * n_free);
  assemble();
  place_fault_nodes(condensed);
}

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

/// Which dofs each unknown of dofs_ moves with.
void TwoSidedBulk::find_terms(int n_u) {
  const Mesh& mesh = problem_.mesh;
  prescribed_.assign(n_u, 0);
  const auto for_each_root = [&](const auto& visit) {
    for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
      for (int c = 0; c < 3 && mesh.tied_to[i] == i; ++c) visit(i, c, dofs_->terms(i, c).empty());
  };
  for_each_root([&](int node, int c, bool is_prescribed) {
    if (rank_[node] >= 0) prescribed_[dof(node, c)] = is_prescribed;
  });
  term_begin_ = {0};
  for_each_root([&](int node, int c, bool is_prescribed) {
    const NodeTerms all = copies_->displacement(node);
    const bool first_is = prescribed_[dof(all.front().node, c)] != 0;
    if (is_prescribed != first_is) refuse_half_held(mesh.nodes[node]);
    if (is_prescribed) return;
    // What is prescribed at a place is so on all copies and has no part in jumps.
    for (const NodeTerm& term : all) {
      const int moved = dof(term.node, c);
      if (!prescribed_[moved]) terms_.push_back({moved, term.factor});
    }
    term_begin_.push_back(static_cast<int>(terms_.size()));
  });
  FAULTSIM_DEMAND(std::ssize(term_begin_) == 1 + dofs_->n_unknowns(), term_begin_.size(), " of ",
                  dofs_->n_unknowns());
}

/// K over all dofs: terms of both, and the mean diagonal in prescribed rows.
void TwoSidedBulk::assemble() {
  SparseMatrix lower =
      assemble_stiffness(problem_.mesh, problem_.materials, *dofs_, problem_.mean_dilatation);
  mean_diagonal_ = lower.diagonal().mean();
  const auto n_u = static_cast<int>(prescribed_.size());
  SparseMatrix fixed(n_u, n_u);
  fixed.reserve(n_u);
  for (int i = 0; i < n_u; ++i) {
    fixed.startVec(i);
    if (prescribed_[i]) fixed.insertBack(i, i) = mean_diagonal_;
  }
  fixed.finalize();
  SparseMatrix free;
  if (std::ssize(terms_) == dofs_->n_unknowns()) {
    free = both_triangles(lower, mapped(terms_, &Term::dof), n_u);
  } else {
    const SparseMatrix moves = moved_by_dofs();
    const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
    free = SparseMatrix(moves.transpose()) * SparseMatrix(whole * moves);
  }
  lower = SparseMatrix();
  stiffness_ = free + fixed;
}

/// Unknowns of dofs_ x dofs.
SparseMatrix TwoSidedBulk::moved_by_dofs() const {
  std::vector<Eigen::Triplet<double, long>> entries;
  for (int unknown = 0; unknown < dofs_->n_unknowns(); ++unknown)
    for (const Term& term : terms(unknown)) entries.emplace_back(unknown, term.dof, term.factor);
  SparseMatrix moves(dofs_->n_unknowns(), std::ssize(prescribed_));
  moves.setFromTriplets(entries.begin(), entries.end());
  return moves;
}

void TwoSidedBulk::place_fault_nodes(const DofMap& condensed) {
  for (int f = 0; f < static_cast<int>(copies_->faults().size()); ++f) {
    const std::vector<FaultNode>& nodes = copies_->faults()[f].nodes;
    for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
      const FaultNode& node = nodes[k];
      TwoSidedNode two;
      two.frame << node.normal, node.strike, node.dip;
      two.area = node.area;
      for (int c = 0; c < 3; ++c) two.jump[c] = condensed.jump_dof(f, k, c);
      for (const NodeTerm& term : copies_->jump(f, k)) {
        JumpTerm& moved = two.terms.emplace_back();
        moved.factor = term.factor;
        for (int c = 0; c < 3; ++c) {
          const int its_dof = dof(term.node, c);
          moved.dof[c] = prescribed_[its_dof] ? -1 : its_dof;
        }
      }
      fault_nodes_.push_back(two);
    }
  }
}

Eigen::VectorXd TwoSidedBulk::load(int k) const {
  const Eigen::VectorXd force = unit_load(problem_, *dofs_, k);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n_displacements());
  for (int unknown = 0; unknown < dofs_->n_unknowns(); ++unknown) {
    for (const auto& [i, factor] : terms(unknown)) f[i] += factor * force[unknown];
  }
  for_each_free_node([&](int node) {
    for (int c = 0; c < 3; ++c) {
      const int i = dof(node, c);
      if (prescribed_[i]) f[i] = mean_diagonal_ * dofs_->prescribed(k, node, c);
    }
  });
  return f;
}

Eigen::Matrix3Xd TwoSidedBulk::nodal_displacement(const Eigen::VectorXd& u) const {
  const Mesh& mesh = problem_.mesh;
  Eigen::Matrix3Xd all = Eigen::Matrix3Xd::Zero(3, std::ssize(mesh.nodes));
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    for (const NodeTerm& term : copies_->displacement(mesh.tied_to[i]))
      all.col(i) += term.factor * u.segment<3>(dof(term.node, 0));
  }
  return all;
}

Eigen::MatrixXd TwoSidedBulk::rigid_motions() const {
  const Mesh& mesh = problem_.mesh;
  const RigidModes modes = rigid_modes(
      mesh, [](int) { return true; }, [](int, int) { return false; });
  Eigen::MatrixXd motions(n_displacements(), 6);
  for_each_free_node(
      [&](int node) { motions.middleRows(dof(node, 0), 3) = modes.at(mesh.nodes[node]); });
  return Eigen::HouseholderQR<Eigen::MatrixXd>(motions).householderQ() *
         Eigen::MatrixXd::Identity(n_displacements(), 6);
}

}  // namespace faultsim
