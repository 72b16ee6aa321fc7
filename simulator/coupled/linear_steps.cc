#include "simulator/coupled/linear_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace faultsim {
namespace {

/// What a set-up costs: two to three with AMG on graded cells, more on cubes.
constexpr double kSetupInIterations = 4;

}  // namespace

void LinearSteps::take(SaddlePoint j, Solved& solved) {
  auto next = std::make_unique<SaddlePoint>(std::move(j));
  const bool may_keep = solver_ && runs_on_ranks(choice_) && lost_ <= kSetupInIterations;
  if (may_keep) solver_->relinearise(*next);
  if (!may_keep) solver_.reset();
  j_ = std::move(next);
  is_new_ = !may_keep;
  if (is_new_) set_up(solved);
}

void LinearSteps::set_up(Solved& solved) {
  solver_.reset();  // the old one's memory first
  solver_ = std::make_unique<CoupledSolver>(*j_, choice_);
  solved.setup_seconds += solver_->setup_seconds();
  lost_ = 0;
}

void LinearSteps::solve_to(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u,
                           Eigen::VectorXd& lambda, Solved& solved) {
  CoupledReport& report = solved.report;
  report = solver_->solve(f, g, solved.tolerance, choice_.max_iterations, u, lambda);
  if (!report.converged && !is_new_) {
    const double seconds = report.seconds;
    is_new_ = true;
    set_up(solved);
    report = solver_->solve(f, g, solved.tolerance, choice_.max_iterations, u, lambda);
    report.seconds += seconds;
  }
  const double decades = -std::log10(solved.tolerance);
  const auto n = static_cast<double>(report.residuals.size() - 1);
  if (is_new_) per_decade_ = n / decades;
  lost_ += std::max(0.0, n - per_decade_ * decades);
}

double ForcingTerm::next(double norm) {
  constexpr double kGamma = 0.9;
  double term = loosest_;
  if (norm_ > 0) {
    const double ratio = norm / norm_, before = kGamma * term_ * term_;
    term = kGamma * ratio * ratio;
    if (before > 0.1) term = std::max(term, before);  // no faster than it ought to fall
  } else {
    first_ = norm;
  }
  term = std::min(term, loosest_);
  if (norm > 0) term = std::max(term, std::min(loosest_, asked_ * first_ / norm));
  norm_ = norm;
  term_ = term;
  return term;
}

}  // namespace faultsim
