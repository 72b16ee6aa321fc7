#include "simulator/coupled/solver_study.h"

#include <algorithm>
#include <cmath>
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

double relative_residual(const SaddlePoint& j, const StudyLoad& load, const Eigen::VectorXd& u,
                         const Eigen::VectorXd& lambda) {
  const double scale = scale_of_multipliers(j);
  const Eigen::VectorXd r_u = load.f - j.leading() * u - j.coupling * lambda;
  const Eigen::VectorXd r_l = scale * (load.g - j.constraint.transpose() * u);
  return std::hypot(r_u.norm(), r_l.norm()) / std::hypot(load.f.norm(), scale * load.g.norm());
}

}  // namespace

StudyLoad random_load(const TwoSidedBulk& bulk, const SaddlePoint& j) {
  const Eigen::VectorXd all = random_vector(j.n_displacements() + j.n_multipliers());
  StudyLoad load{all.head(j.n_displacements()),
                 all.tail(j.n_multipliers()) / scale_of_multipliers(j)};
  for (int i = 0; i < j.n_displacements(); ++i) {
    if (bulk.is_prescribed(i)) load.f[i] = 0;
  }
  return load;
}

StudyLoad physical_load(const TwoSidedBulk& bulk, const SaddlePoint& j) {
  return {bulk.load(0), Eigen::VectorXd::Zero(j.n_multipliers())};
}

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
  row.true_residual = 0;
  const auto solve = [&](const StudyLoad& load) {
    constexpr double kTolerance = 1e-8;
    Eigen::VectorXd u, lambda;
    const CoupledReport report =
        solver->solve(load.f, load.g, kTolerance, max_iterations, u, lambda);
    row.true_residual = std::max(row.true_residual, relative_residual(j, load, u, lambda));
    return report;
  };
  const CoupledReport random = solve(random_load(bulk, j));
  row.random = counts(random);
  row.solve_seconds = random.seconds;
  row.physical = counts(solve(physical_load(bulk, j)));
  return row;
}

}  // namespace faultsim
