#include "simulator/coupled/solver_study.h"

#include <random>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// Entries in [−1, 1] that are the same with every standard library.
Eigen::VectorXd random_vector(int n) {
  std::mt19937_64 engine(18);
  Eigen::VectorXd values(n);
  for (double& value : values) value = static_cast<double>(engine() >> 11) * 0x1p-52 - 1;
  return values;
}

StudyRow::Counts counts(const CoupledReport& report) {
  return {report.iterations_to(1e-6), report.iterations_to(1e-8)};
}

}  // namespace

StudyRow study(const TwoSidedBulk& bulk, const SaddlePoint& j, const SolverChoice& choice,
               int max_iterations) {
  StudyRow row;
  row.choice = choice;
  row.n_displacements = j.n_displacements();
  row.n_multipliers = j.n_multipliers();
  row.leading_nonzeros = bulk.n_entries();
  row.constraint_nonzeros = j.constraint.nonZeros();
  std::unique_ptr<CoupledSolver> solver;
  try {
    solver = std::make_unique<CoupledSolver>(j, choice);
  } catch (const ResourceError& error) {
    row.failure = error.what();
    return row;
  }
  row.setup_seconds = solver->setup_seconds();
  row.bytes = solver->preconditioner_bytes();
  constexpr double kTolerance = 1e-8;
  Eigen::VectorXd u, lambda, f = random_vector(row.n_displacements + row.n_multipliers);
  const Eigen::VectorXd g = f.tail(row.n_multipliers) / solver->multiplier_scale();
  f.conservativeResize(row.n_displacements);
  for (int i = 0; i < row.n_displacements; ++i) {
    if (bulk.is_prescribed(i)) f[i] = 0;
  }
  const CoupledReport report = solver->solve(f, g, kTolerance, max_iterations, u, lambda);
  row.random = counts(report);
  row.solve_seconds = report.seconds;
  row.physical = counts(solver->solve(bulk.load(0), Eigen::VectorXd::Zero(row.n_multipliers),
                                      kTolerance, max_iterations, u, lambda));
  return row;
}

}  // namespace faultsim
