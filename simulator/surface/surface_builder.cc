#include "simulator/surface/surface_builder.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/common/machine.h"
#include "simulator/common/text.h"
#include "simulator/linalg/dense_cholesky.h"
#include "simulator/surface/adaptive_interpolant.h"
#include "simulator/surface/case_errors.h"
#include "simulator/surface/operator_nodes.h"
#include "simulator/surface/stability_limit.h"

namespace faultsim {
namespace {

std::string brief(double value) { return formatted("%.2g", value); }

double relative(double error, double size) { return size > 0 ? error / size : error; }

/// Slip of faults without friction, H g = A L_k, a column per load: the softest modes of H, which
/// its norm does not show, weigh most here. Nothing where H is not positive definite.
std::optional<Eigen::MatrixXd> slip_without_friction(const FaultOperator& op,
                                                     const Eigen::VectorXd& area) {
  DenseCholesky factor;
  if (!factor.factor(op.h())) return std::nullopt;
  Eigen::MatrixXd slip(area.size(), op.loads.traction.cols());
  for (Eigen::Index k = 0; k < slip.cols(); ++k)
    slip.col(k) = factor.solve(area.cwiseProduct(op.loads.traction.col(k)));
  return slip;
}

constexpr std::size_t kCasesAtAPoint = 4;

/// Of |H|, by which what directions say of two runs of jumps may be off: slip without friction is
/// then off by three to six times as much (results/surfaces).
double left_out_of_blocks(double tolerance) { return std::min(1e-5, tolerance / 100); }

/// A place where the surface is held against the exact operator.
struct Check {
  Eigen::VectorXd x;
  std::shared_ptr<const FaultOperator> exact;
  std::vector<CaseResult> cases = {};  ///< on `exact`; empty until they are asked for, as are
  Eigen::MatrixXd slip = {};           ///< without friction, of `exact`, and its
  std::vector<double> stability = {};  ///< limits.
};

/// What it takes to go from one grid to a finer one.
class Builder {
 public:
  Builder(const SurfaceRequest& request, const ExactOperator& exact, const ProbingCases& cases,
          const RunContext& context);
  StoredSurface build(const std::string& fingerprint);

 private:
  std::shared_ptr<const FaultOperator> ask(const Eigen::VectorXd& x, const std::string& what);
  void require_memory(double bytes, const char* what) const;
  OperatorBasis compressed(double tolerance) const;
  void tell(const char* what, const Check& check) const;
  void make_checks(int n_axes);
  std::span<Check> deciding_checks();
  std::span<Check> other_checks() { return std::span(checks_).last(checks_.size() / 2); }
  std::shared_ptr<const FaultOperator> interpolated(
      const std::shared_ptr<const OperatorBasis>& basis, const SparseGrid& grid,
      const Check& check) const;
  CaseSurface measured(const std::shared_ptr<const OperatorBasis>& basis, const SparseGrid& grid);
  static void look_at_exact(Check& check);
  static void measure(const FaultOperator& op, const Check& check, CaseSurface& worst);
  CaseErrors errors_of_cases(const std::shared_ptr<const OperatorBasis>& basis,
                             const SparseGrid& grid, std::span<Check> checks);
  void run_exact(Check& check);
  CaseResult run(std::size_t k, const Check& check, const std::shared_ptr<const FaultOperator>& op);
  bool is_fine(const std::shared_ptr<const OperatorBasis>& basis, const SparseGrid& grid,
               CaseSurface& found);
  [[noreturn]] void refuse(const CaseSurface& found) const;

  const SurfaceRequest& request_;
  const ExactOperator& exact_;
  const ProbingCases& cases_;
  const RunContext& context_;
  OperatorNodes nodes_;
  std::vector<Check> checks_;
};

Builder::Builder(const SurfaceRequest& request, const ExactOperator& exact,
                 const ProbingCases& cases, const RunContext& context)
    : request_(request),
      exact_(exact),
      cases_(cases),
      context_(context),
      nodes_(ask(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(request.over.size())),
                 "operator 1")) {
  DenseCholesky factor;
  if (!factor.factor(nodes_.centre()->h())) {
    refuse_surface("a piece that faults cut loose moves freely, so that H is not positive definite",
                   "use exact operators");
  }
}

std::shared_ptr<const FaultOperator> Builder::ask(const Eigen::VectorXd& x,
                                                  const std::string& what) {
  context_.stop.throw_if_requested("building a surface of operators");
  PartMonitor monitor(context_.monitor, what + " of a surface");
  RunContext context = context_;
  context.monitor = &monitor;
  return exact_(x, context);
}

void Builder::require_memory(double bytes, const char* what) const {
  const auto free = available_memory();
  if (!free || bytes <= *free) return;
  throw ResourceError(concat(what, " of the surface need ", brief(bytes / 1e9),
                             " GB of memory, but there are ", brief(*free / 1e9),
                             " GB; give operators a cache, narrow the surface's ranges, raise its "
                             "tolerance, or use a coarser tier"));
}

/// What is left out of H in all nodes together is below a twentieth of `tolerance`.
OperatorBasis Builder::compressed(double tolerance) const {
  context_.progress(0, "compressing a surface");
  const Eigen::MatrixXd gram = nodes_.stiffness_gram(context_.stop);
  const Eigen::Index m = gram.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);  // ascending
  const double least = std::pow(tolerance / 20, 2);
  Eigen::Index n_left_out = 0;
  double left_out = 0;  // sum of squares over all nodes
  while (n_left_out < m && left_out + std::max(0.0, solver.eigenvalues()[n_left_out]) <= least)
    left_out += std::max(0.0, solver.eigenvalues()[n_left_out++]);
  return nodes_.basis(solver.eigenvectors().rightCols(m - n_left_out),
                      left_out_of_blocks(request_.tolerance), context_.stop);
}

void Builder::make_checks(int n_axes) {
  if (!checks_.empty()) return;
  for (const Eigen::VectorXd& x : check_points(n_axes, n_surface_checks(request_)))
    checks_.push_back({x, ask(x, concat("check point ", checks_.size() + 1))});
}

void Builder::tell(const char* what, const Check& check) const {
  const auto k = &check - checks_.data();
  context_.progress(static_cast<double>(k) / static_cast<double>(checks_.size()),
                    concat(what, " at check point ", k + 1, " of a surface"));
}

/// Those whose cases say when the grid is fine enough; the others then say how fine it is.
std::span<Check> Builder::deciding_checks() {
  return std::span(checks_).first(checks_.size() - checks_.size() / 2);
}

std::shared_ptr<const FaultOperator> Builder::interpolated(
    const std::shared_ptr<const OperatorBasis>& basis, const SparseGrid& grid,
    const Check& check) const {
  auto op = std::make_shared<FaultOperator>();
  const Eigen::VectorXd w = grid.weights(check.x);
  OperatorBasis::put(basis, w.tail(w.size() - 1), *op);
  op->geometry = check.exact->geometry;
  op->fingerprint = basis->fingerprint;
  return op;
}

void Builder::look_at_exact(Check& check) {
  if (check.slip.size() > 0) return;
  const auto slip = slip_without_friction(*check.exact, check.exact->geometry.dof_area);
  if (!slip) refuse_surface("an exact H is not positive definite", "use exact operators");
  check.slip = *slip;
  check.stability = stability_limits(check.exact->geometry, check.exact->h());
}

void Builder::measure(const FaultOperator& op, const Check& check, CaseSurface& worst) {
  const FaultOperator& exact = *check.exact;
  const auto raise = [](double& member, double error) { member = std::max(member, error); };
  raise(worst.stiffness, relative((op.h() - exact.h()).norm(), exact.h().norm()));
  raise(worst.traction, worst_column(op.loads.traction, exact.loads.traction));
  const Observations &seen = op.observed, &truth = exact.observed;
  raise(worst.observation,
        std::max(relative((seen.per_load - truth.per_load).norm(), truth.per_load.norm()),
                 relative((seen.per_jump - truth.per_jump).norm(), truth.per_jump.norm())));
  const auto slip = slip_without_friction(op, exact.geometry.dof_area);
  raise(worst.slip,
        slip ? worst_column(*slip, check.slip) : std::numeric_limits<double>::infinity());
  const std::vector<double> limits = stability_limits(exact.geometry, op.h());
  for (std::size_t f = 0; f < limits.size(); ++f) {
    if (std::isnan(check.stability[f])) continue;
    const double error = std::abs(limits[f] / check.stability[f] - 1);
    worst.stability = std::max(worst.stability.value_or(0), error);
  }
}

CaseSurface Builder::measured(const std::shared_ptr<const OperatorBasis>& basis,
                              const SparseGrid& grid) {
  CaseSurface worst{.n_operators = grid.n_nodes(),
                    .n_basis = static_cast<int>(basis->size()),
                    .n_checks = static_cast<int>(checks_.size()),
                    .tolerance = request_.tolerance};
  for (Check& check : checks_) {
    context_.stop.throw_if_requested("measuring a surface of operators");
    tell("errors", check);
    look_at_exact(check);
    measure(*interpolated(basis, grid, check), check, worst);
  }
  return worst;
}

/// The k-th case of a check point: all points together go through all cases, in turn.
CaseResult Builder::run(std::size_t k, const Check& check,
                        const std::shared_ptr<const FaultOperator>& op) {
  context_.stop.throw_if_requested("running cases on a surface of operators");
  const auto n = static_cast<std::size_t>(cases_.n);
  const auto place = static_cast<std::size_t>(&check - checks_.data());
  return cases_.run(static_cast<int>((place * kCasesAtAPoint + k) % n), check.x, op);
}

void Builder::run_exact(Check& check) {
  const std::size_t n = std::min(kCasesAtAPoint, static_cast<std::size_t>(cases_.n));
  while (check.cases.size() < n) check.cases.push_back(run(check.cases.size(), check, check.exact));
}

CaseErrors Builder::errors_of_cases(const std::shared_ptr<const OperatorBasis>& basis,
                                    const SparseGrid& grid, std::span<Check> checks) {
  CaseErrors worst;
  for (Check& check : checks) {
    tell("cases", check);
    run_exact(check);
    const auto op = interpolated(basis, grid, check);
    for (std::size_t k = 0; k < check.cases.size(); ++k)
      worst.take_larger(case_errors(run(k, check, op), check.cases[k]));
  }
  return worst;
}

/// Whether the grid is within the tolerance, and what is known of it: with cases, of the operators
/// only once it is.
bool Builder::is_fine(const std::shared_ptr<const OperatorBasis>& basis, const SparseGrid& grid,
                      CaseSurface& found) {
  make_checks(grid.n_axes());
  if (cases_.n == 0) {
    found = measured(basis, grid);
    return std::max({found.stiffness, found.traction, found.observation, found.slip}) <=
           request_.tolerance;
  }
  const CaseErrors deciding = errors_of_cases(basis, grid, deciding_checks());
  const bool seems_fine = deciding.within(cases_.tolerance);
  const CaseErrors said = seems_fine ? errors_of_cases(basis, grid, other_checks()) : deciding;
  const bool is_within = seems_fine && said.are_known();
  if (is_within) found = measured(basis, grid);
  found.n_operators = grid.n_nodes();
  found.n_cases = 0;
  for (const Check& check : seems_fine ? other_checks() : deciding_checks())
    found.n_cases += static_cast<int>(check.cases.size());
  found.chi_tolerance = cases_.tolerance;
  found.chi_bar = said.chi_bar;
  found.largest_slip = said.largest_slip;
  found.flags_that_differ = said.flags_that_differ;
  return is_within;
}

void Builder::refuse(const CaseSurface& found) const {
  const std::string errors =
      found.chi_bar && std::isinf(*found.chi_bar)
          ? "a probing case opens a fault, or ends early, on one of exact and interpolated "
            "operators alone"
      : found.chi_bar
          ? concat("χ̄ of its probing cases is off by ", brief(*found.chi_bar),
                   ", their largest slip by ", brief(*found.largest_slip), " of the case's; ",
                   brief(cases_.tolerance), " of χ̄ and ten times that of slip are asked for")
          : concat("H is off by ", brief(found.stiffness), ", locked tractions by ",
                   brief(found.traction), ", observations by ", brief(found.observation),
                   ", slip without friction by ", brief(found.slip), "; ",
                   brief(request_.tolerance), " is asked for");
  refuse_surface(concat("the surface does not reach its tolerance: with ", found.n_operators,
                        " operators ", errors),
                 "narrow its ranges, raise tolerance or most_operators, or use exact operators");
}

StoredSurface Builder::build(const std::string& fingerprint) {
  int n_asked = 1;
  AdaptiveInterpolant interpolant(static_cast<int>(request_.over.size()),
                                  [&](const Eigen::VectorXd& x, const Eigen::VectorXd& weights) {
                                    const double n = nodes_.centre()->geometry.n_dofs;
                                    require_memory(3 * sizeof(double) * n * n, "the nodes");
                                    const auto op = ask(x, concat("operator ", ++n_asked));
                                    const double surplus =
                                        nodes_.surplus(*op, weights, context_.stop);
                                    nodes_.add(op);
                                    return surplus;
                                  });
  // Cases forgive more than norms do: they are asked from a coarse grid on.
  constexpr double kFirstSurplus = 0.1, kRounding = 1e-13;  // nothing is gained below it
  const bool has_cases = cases_.n > 0;
  for (double surplus = has_cases ? kFirstSurplus : request_.tolerance;; surplus /= 1.5) {
    const int n_before = interpolant.grid().n_nodes();
    interpolant.grow(surplus, request_.most_operators);
    const SparseGrid& grid = interpolant.grid();
    const bool is_full = grid.n_nodes() >= request_.most_operators || surplus < kRounding;
    if (has_cases && grid.n_nodes() == n_before && !is_full) continue;
    const auto basis = std::make_shared<OperatorBasis>(compressed(surplus));
    basis->fingerprint = fingerprint;
    basis->nodes = grid.indices();
    CaseSurface found;
    if (is_fine(basis, grid, found)) return {basis, found};
    if (is_full) refuse(found);
  }
}

}  // namespace

void refuse_surface(const std::string& what, const std::string& cure) {
  throw InputError("scene", {{"/numerics/surface", 0, what, cure}});
}

double worst_column(const Eigen::MatrixXd& value, const Eigen::MatrixXd& exact) {
  double worst = 0;
  for (Eigen::Index k = 0; k < exact.cols(); ++k)
    worst = std::max(worst, relative((value.col(k) - exact.col(k)).norm(), exact.col(k).norm()));
  return worst;
}

std::vector<Eigen::VectorXd> check_points(int n_axes, int n_points) {
  std::mt19937 random(7);
  std::vector<Eigen::VectorXd> points;
  for (int i = 0; i < n_points; ++i) {
    Eigen::VectorXd x(n_axes);
    for (double& one : x) one = -1 + 2 * (static_cast<double>(random()) / 4294967296.0);
    points.push_back(x);
  }
  return points;
}

StoredSurface build_surface(const SurfaceRequest& request, const std::string& fingerprint,
                            const ExactOperator& exact, const ProbingCases& cases,
                            const RunContext& context) {
  return Builder(request, exact, cases, context).build(fingerprint);
}

}  // namespace faultsim
