#include "simulator/coupled/two_sided_bulk.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/elasticity/held.h"
#include "simulator/elasticity/rigid_modes.h"
#include "simulator/linalg/partition.h"

namespace faultsim {
namespace {

[[noreturn]] void refuse_half_held(const Eigen::Vector3d& x) {
  throw InputError("coupled path",
                   {{"/geometry/boundary", 0,
                     concat("at (", x.x(), ", ", x.y(), ", ", x.z(),
                            ") m a condition holds one side of a fault but not the other"),
                     "let it hold both sides, or use the condensed path"}});
}

/// The rows `first` … `first + n_own − 1` of a symmetric matrix of size n with row and column k of
/// `lower` at place[k], and of `fixed` on the diagonal; each as a column. Sorted where `place`
/// ascends.
SparseMatrix rows_of(const SparseMatrix& lower, const std::vector<int>& place,
                     const std::vector<std::pair<int, double>>& fixed, int n, int first,
                     int n_own) {
  std::vector<long> next(1 + n_own, 0);
  const auto is_own = [&](int k) { return k >= first && k < first + n_own; };
  const auto for_each_entry = [&](const auto& visit) {  // (row, own column, value), rows ascending
    for (int column = 0; column < static_cast<int>(lower.cols()); ++column) {
      for (SparseMatrix::InnerIterator it(lower, column); it; ++it) {
        const int i = place[it.row()], j = place[column];
        if (is_own(j)) visit(i, j - first, it.value());
        if (i != j && is_own(i)) visit(j, i - first, it.value());
      }
    }
    for (const auto& [k, value] : fixed)
      if (is_own(k)) visit(k, k - first, value);
  };
  for_each_entry([&](int, int column, double) { ++next[1 + column]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  SparseMatrix rows(n, n_own);
  rows.resizeNonZeros(next.back());
  std::ranges::copy(next, rows.outerIndexPtr());
  for_each_entry([&](int row, int column, double value) {
    const long at = next[column]++;
    rows.innerIndexPtr()[at] = row;
    rows.valuePtr()[at] = value;
  });
  return rows;
}

}  // namespace

TwoSidedBulk::TwoSidedBulk(const BulkProblem& problem, LoosePieces loose, const Ranks& ranks)
    : problem_(problem), ranks_(ranks) {
  const int n_loads = static_cast<int>(problem.loads.size());
  const DofMap condensed(problem.mesh, problem.conditions, n_loads);
  require_held(problem.mesh, condensed);
  copies_ = std::make_unique<FreeCopies>(
      problem_.mesh, [&](int fault, int node) { return condensed.jump_dof(fault, node, 0) >= 0; });
  dofs_ = std::make_unique<DofMap>(problem_.mesh, problem.conditions, n_loads);
  if (loose == LoosePieces::refused) require_pieces_held();
  number_dofs();
  find_terms();
  place_fault_nodes(condensed);
  SparseMatrix lower = lower_of_own();
  find_mean_diagonal(lower);
  rows_ = std::make_unique<const SparseMatrix>(own_rows(std::move(lower)));
  n_entries_ = rows_->nonZeros();
}

/// Rank by rank, and in the order of the nodes within.
void TwoSidedBulk::number_dofs() {
  const std::vector<int> owner = owners();
  rank_.assign(owner.size(), -1);
  ranges_.begin = {0};
  int n_free = 0;
  for (int r = 0; r < ranks_.size(); ++r) {
    for (std::size_t i = 0; i < owner.size(); ++i)
      if (owner[i] == r) rank_[i] = n_free++;
    ranges_.begin.push_back(3 * n_free);
  }
}

/// The rank of each node that moves by itself, −1 of others: what METIS makes of the cells, with
/// all nodes that one jump is between as one vertex.
std::vector<int> TwoSidedBulk::owners() const {
  const Mesh& mesh = problem_.mesh;
  const int n_nodes = static_cast<int>(mesh.nodes.size());
  const auto is_free = [&](int i) { return mesh.tied_to[i] == i && copies_->is_free(i); };
  std::vector<int> owner(n_nodes, -1);
  if (ranks_.size() == 1) {
    for (int i = 0; i < n_nodes; ++i)
      if (is_free(i)) owner[i] = 0;
    return owner;
  }
  DisjointSets together(n_nodes);
  for (std::size_t f = 0; f < copies_->faults().size(); ++f) {
    for (std::size_t k = 0; k < copies_->faults()[f].nodes.size(); ++k) {
      const NodeTerms& jump = copies_->jump(static_cast<int>(f), static_cast<int>(k));
      for (const NodeTerm& term : jump)
        together.join(mesh.tied_to[jump.front().node], mesh.tied_to[term.node]);
    }
  }
  VertexCells cells;
  std::vector<int> vertex(n_nodes, -1);
  for (int i = 0; i < n_nodes; ++i) {
    if (!is_free(i)) continue;
    int& of_root = vertex[together.find(i)];
    if (of_root < 0) {
      of_root = cells.n_vertices++;
      cells.weight.push_back(0);
    }
    vertex[i] = of_root;
    ++cells.weight[of_root];
  }
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    for (const int node : mesh.cells[cell])
      if (is_free(mesh.tied_to[node])) cells.vertices.push_back(vertex[mesh.tied_to[node]]);
    cells.begin.push_back(static_cast<int>(cells.vertices.size()));
  }
  const std::vector<int> part = partition(cells, ranks_.size());
  for (int i = 0; i < n_nodes; ++i)
    if (is_free(i)) owner[i] = part[vertex[i]];
  return owner;
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
          "hold it by a boundary condition, use rac as the Schur complement, or use the "
          "condensed path"}});
  }
}

/// Which dofs each unknown of dofs_ moves with.
void TwoSidedBulk::find_terms() {
  const Mesh& mesh = problem_.mesh;
  prescribed_.assign(n_displacements(), 0);
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

/// Cells of the unknowns that move with an own dof; empty: all.
std::vector<char> TwoSidedBulk::cells_of_own_rows() const {
  if (ranks_.size() == 1) return {};
  const auto is_own = [&](const Term& term) {
    return term.dof >= first_own() && term.dof < first_own() + n_own();
  };
  const Mesh& mesh = problem_.mesh;
  std::vector<char> wanted(mesh.cells.size(), 0);
  for (std::size_t cell = 0; cell < wanted.size(); ++cell) {
    for (const int node : mesh.cells[cell]) {
      for (int c = 0; c < 3 && wanted[cell] == 0; ++c)
        for (const DofMap::Term& term : dofs_->terms(node, c))
          if (std::ranges::any_of(terms(term.unknown), is_own)) wanted[cell] = 1;
    }
  }
  return wanted;
}

SparseMatrix TwoSidedBulk::lower_of_own() const {
  return assemble_stiffness(problem_.mesh, problem_.materials, *dofs_, problem_.mean_dilatation,
                            cells_of_own_rows());
}

/// Of all unknowns, each counted where its first dof is.
void TwoSidedBulk::find_mean_diagonal(const SparseMatrix& lower) {
  double sum = 0;
  for (int unknown = 0; unknown < dofs_->n_unknowns(); ++unknown) {
    const int dof = terms(unknown).front().dof - first_own();
    if (dof >= 0 && dof < n_own()) sum += lower.coeff(unknown, unknown);
  }
  mean_diagonal_ = ranks_.sum(sum) / dofs_->n_unknowns();
}

/// K over all dofs: terms of both, and the mean diagonal in prescribed rows.
SparseMatrix TwoSidedBulk::own_rows(SparseMatrix lower) const {
  const int n_u = n_displacements();
  std::vector<std::pair<int, double>> fixed;
  for (int i = 0; i < n_u; ++i)
    if (prescribed_[i]) fixed.emplace_back(i, mean_diagonal_);
  if (std::ssize(terms_) == dofs_->n_unknowns())
    return rows_of(lower, mapped(terms_, &Term::dof), fixed, n_u, first_own(), n_own());
  const SparseMatrix alone = rows_of(SparseMatrix(), {}, fixed, n_u, first_own(), n_own());
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  lower = SparseMatrix();
  const SparseMatrix moved = whole * moved_by_dofs(true);
  return SparseMatrix(moved_by_dofs(false).transpose()) * moved + alone;
}

/// Unknowns of dofs_ x dofs, all or the own ones.
SparseMatrix TwoSidedBulk::moved_by_dofs(bool only_own) const {
  const int first = only_own ? first_own() : 0, n = only_own ? n_own() : n_displacements();
  std::vector<Eigen::Triplet<double, long>> entries;
  for (int unknown = 0; unknown < dofs_->n_unknowns(); ++unknown)
    for (const Term& term : terms(unknown))
      if (term.dof >= first && term.dof < first + n)
        entries.emplace_back(unknown, term.dof - first, term.factor);
  SparseMatrix moves(dofs_->n_unknowns(), n);
  moves.setFromTriplets(entries.begin(), entries.end());
  return moves;
}

/// All copies of an own fault node with each other: what springs and friction tie together.
SparseMatrix TwoSidedBulk::room_of_faults() const {
  std::vector<Eigen::Triplet<double, long>> entries;
  for (const TwoSidedNode& node : fault_nodes_) {
    if (!owns(node)) continue;
    std::vector<int> own;
    for (const JumpTerm& term : node.terms)
      for (const int dof : term.dof)
        if (dof >= 0) own.push_back(dof - first_own());
    for (const int a : own)
      for (const int b : own) entries.emplace_back(a, b, 0.0);
  }
  SparseMatrix room(n_own(), n_own());
  room.setFromTriplets(entries.begin(), entries.end());
  return room;
}

const SparseMatrix& TwoSidedBulk::stiffness() const {
  FAULTSIM_DEMAND(ranks_.size() == 1, "the whole matrix on one of ", ranks_.size(), " ranks");
  if (!rows_) rows_ = std::make_unique<const SparseMatrix>(own_rows(lower_of_own()));
  return *rows_;
}

EngineMatrix& TwoSidedBulk::engine() const {
  if (!engine_) {
    engine_ = std::make_unique<EngineMatrix>(rows_ ? *rows_ : own_rows(lower_of_own()), ranges_,
                                             ranks_, room_of_faults());
    rows_.reset();
  }
  return *engine_;
}

Eigen::VectorXd TwoSidedBulk::times_stiffness(const Eigen::VectorXd& u) const {
  const bool whole = !engine_ && ranks_.size() == 1;
  return whole ? Eigen::VectorXd(stiffness() * u) : engine().times(u);
}

Eigen::VectorXd TwoSidedBulk::diagonal() const {
  const bool whole = !engine_ && ranks_.size() == 1;
  return whole ? Eigen::VectorXd(stiffness().diagonal()) : engine().diagonal();
}

void TwoSidedBulk::place_fault_nodes(const DofMap& condensed) {
  for (int f = 0; f < static_cast<int>(copies_->faults().size()); ++f) {
    const std::vector<FaultNode>& nodes = copies_->faults()[f].nodes;
    for (int k = 0; k < static_cast<int>(nodes.size()); ++k) {
      const FaultNode& node = nodes[k];
      TwoSidedNode two;
      two.frame << node.normal, node.strike, node.dip;
      two.area = node.area;
      two.owner = 0;
      for (int c = 0; c < 3; ++c) two.jump[c] = condensed.jump_dof(f, k, c);
      for (const NodeTerm& term : copies_->jump(f, k)) {
        JumpTerm& moved = two.terms.emplace_back();
        moved.factor = term.factor;
        for (int c = 0; c < 3; ++c) {
          const int its_dof = dof(term.node, c);
          moved.dof[c] = prescribed_[its_dof] ? -1 : its_dof;
        }
        two.owner = ranges_.owner_of(dof(term.node, 0));
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
  return f.segment(first_own(), n_own());
}

Eigen::Matrix3Xd TwoSidedBulk::nodal_displacement(const Eigen::VectorXd& u) const {
  const Mesh& mesh = problem_.mesh;
  const Eigen::VectorXd whole = ranks_.gathered(u);
  Eigen::Matrix3Xd all = Eigen::Matrix3Xd::Zero(3, std::ssize(mesh.nodes));
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    for (const NodeTerm& term : copies_->displacement(mesh.tied_to[i]))
      all.col(i) += term.factor * whole.segment<3>(dof(term.node, 0));
  }
  return all;
}

Eigen::MatrixXd TwoSidedBulk::rigid_motions() const {
  const Mesh& mesh = problem_.mesh;
  const RigidModes modes = rigid_modes(
      mesh, [](int) { return true; }, [](int, int) { return false; });
  Eigen::MatrixXd motions(n_own(), 6);
  for_each_free_node([&](int node) {
    const int row = dof(node, 0) - first_own();
    if (row >= 0 && row < n_own()) motions.middleRows(row, 3) = modes.at(mesh.nodes[node]);
  });
  for (int pass = 0; pass < 2; ++pass) {  // Q = M L⁻ᵀ of MᵀM = L Lᵀ, twice for its accuracy
    Eigen::MatrixXd gram = motions.transpose() * motions;
    ranks_.sum(Eigen::Map<Eigen::VectorXd>(gram.data(), gram.size()));
    const Eigen::LLT<Eigen::MatrixXd> factor(gram);
    FAULTSIM_DEMAND(factor.info() == Eigen::Success, "rigid motions of ", n_displacements(),
                    " dofs depend on each other");
    factor.matrixU().solveInPlace<Eigen::OnTheRight>(motions);
  }
  return motions;
}

}  // namespace faultsim
