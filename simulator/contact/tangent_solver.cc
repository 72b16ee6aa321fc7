#include "simulator/contact/tangent_solver.h"

#include <algorithm>

#include "simulator/linalg/gmres.h"

namespace faultsim {
namespace {

// Only speed depends on these.
constexpr std::size_t kDirect = 160;  // unknowns that are solved for faster by a factorisation
constexpr std::size_t kSmall = 100;   // unknowns for which even an old factor is no help
constexpr int kMany = 20;             // iterations after which a new factor would have been cheaper
constexpr int kMost = 30;             // iterations after which it does not help at all
constexpr int kSpare = 2;             // times as large as needed: block and factor are made anew

}  // namespace

TangentSolver::TangentSolver(const ContactProblem& problem)
    : problem_(problem), block_(problem), preconditioner_(problem.n_dofs(), block_) {}

void TangentSolver::clear() {
  direct_dofs_.clear();
  preconditioner_.clear();
  block_.clear();
}

/// T by its definition, in double precision.
void TangentSolver::assemble(const std::vector<TangentUnknown>& unknowns) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  direct_.resize(n, n);
  for (Eigen::Index v = 0; v < n; ++v) {
    const TangentUnknown& column = unknowns[v];
    const double* h = problem_.compliance.column(column.dof).data();
    for (Eigen::Index u = 0; u < n; ++u) {
      const TangentUnknown& row = unknowns[u];
      const ContactNode& node = problem_.nodes[row.node];
      double sum = row.weight[0] * h[node.dof[0]];
      if (node.n_dofs > 1) sum += row.weight[1] * h[node.dof[1]];
      if (node.n_dofs > 2) sum += row.weight[2] * h[node.dof[2]];
      if (row.node == column.node && column.component > 0) {
        sum += row.own[column.component - 1];
      }
      direct_(u, v) = sum;
    }
  }
}

/// To round-off: by a factorisation, or with the last one as the preconditioner of GMRES where the
/// unknowns are the same, as tangents then differ little.
TangentReport TangentSolver::solve_exactly(const std::vector<TangentUnknown>& unknowns,
                                           const Eigen::VectorXd& right,
                                           Eigen::VectorXd& solution) {
  constexpr double kRoundOff = 1e-13;  // that of a factorisation
  constexpr int kIterations = 15;      // 15 n² products against 2/3 n³ of a factorisation
  assemble(unknowns);
  const bool same =
      std::ranges::equal(unknowns, direct_dofs_,
                         [](const TangentUnknown& unknown, int dof) { return unknown.dof == dof; });
  if (unknowns.size() > kSmall && same) {
    const GmresReport report =
        gmres([&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { y.noalias() = direct_ * x; },
              [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { direct_lu_.solve(y = x); }, right,
              kRoundOff, kIterations, solution);
    if (report.converged) return {solution.allFinite(), report.iterations};
  }
  direct_dofs_.clear();
  if (!direct_lu_.factor(direct_)) return {};
  for (const TangentUnknown& unknown : unknowns) direct_dofs_.push_back(unknown.dof);
  direct_lu_.solve(solution = right);
  return {solution.allFinite(), -1};
}

/// Has the block hold all that the unknowns need of H.
void TangentSolver::cover(const std::vector<TangentUnknown>& unknowns) {
  // The preconditioner reads the block, so they go together. Most nodes have two unknowns.
  if (2 * block_.n_nodes() > kSpare * static_cast<int>(unknowns.size())) {
    preconditioner_.clear();
    block_.clear();
  }
  std::vector<int> nodes, added;
  for (const TangentUnknown& unknown : unknowns)
    if (nodes.empty() || nodes.back() != unknown.node) nodes.push_back(unknown.node);
  for (const int k : nodes)
    if (block_.place(k) < 0) added.push_back(k);
  block_.add(added);
  places_.clear();
  for (const int k : nodes) places_.push_back(block_.place(k));
}

void TangentSolver::multiply(const std::vector<TangentUnknown>& unknowns, const Eigen::VectorXd& x,
                             Eigen::VectorXd& y) {
  const auto first_dof = [&](const TangentUnknown& unknown) {
    return MovingBlock::kDofs * block_.place(unknown.node);
  };
  moving_.setZero(block_.n_vector());
  for (std::size_t v = 0; v < unknowns.size(); ++v)
    moving_[first_dof(unknowns[v]) + unknowns[v].component] = static_cast<float>(x[v]);
  block_.multiply(places_, moving_, response_);
  y.resize(x.size());
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const TangentUnknown& row = unknowns[u];
    const float* at = response_.data() + first_dof(row);
    y[u] = row.weight[0] * at[0] + row.weight[1] * at[1] + row.weight[2] * at[2];
  }
  // Unknowns of a node follow each other.
  for (std::size_t v = 0; v < unknowns.size(); ++v) {
    if (unknowns[v].component == 0) continue;
    const auto c = static_cast<std::size_t>(unknowns[v].component - 1);
    for (std::size_t u = v >= 2 ? v - 2 : 0; u < std::min(v + 3, unknowns.size()); ++u) {
      if (unknowns[u].node != unknowns[v].node) continue;
      y[u] += unknowns[u].own[c] * x[v];
    }
  }
}

bool TangentSolver::iterate(const std::vector<TangentUnknown>& unknowns,
                            const Eigen::VectorXd& right, double residual,
                            Eigen::VectorXd& solution, int& iterations) {
  // It has an unknown for two of these.
  if (tired_ || 2 * preconditioner_.size() > kSpare * static_cast<int>(unknowns.size()))
    preconditioner_.clear();
  if (!preconditioner_.cover(unknowns)) return false;
  const GmresReport report =
      gmres([&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { multiply(unknowns, x, y); },
            [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) { preconditioner_.apply(x, y); },
            right, residual / right.norm(), kMost, solution);
  iterations += report.iterations;
  tired_ = report.iterations > kMany;
  return report.converged && solution.allFinite();
}

TangentReport TangentSolver::solve(const std::vector<TangentUnknown>& unknowns,
                                   const Eigen::VectorXd& right, double residual,
                                   Eigen::VectorXd& solution) {
  if (residual > 0 && unknowns.size() > kDirect) {
    cover(unknowns);
    TangentReport report{true, 0};
    const bool was_there = preconditioner_.size() > 0;
    if (iterate(unknowns, right, residual, solution, report.krylov)) return report;
    preconditioner_.clear();
    if (was_there && iterate(unknowns, right, residual, solution, report.krylov)) return report;
    preconditioner_.clear();
  }
  return solve_exactly(unknowns, right, solution);
}

}  // namespace faultsim
