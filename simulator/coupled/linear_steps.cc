#include "simulator/coupled/linear_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace faultsim {
namespace {

/// What a set-up costs, measured on cubes of 1/16 and 1/32 m: interpolating rotations is dear.
double setup_in_iterations(LeadingKind kind) { return kind == LeadingKind::amg ? 30 : 6; }

}  // namespace

void LinearSteps::take(SaddlePoint j, Solved& solved) {
  auto next = std::make_unique<SaddlePoint>(std::move(j));
  is_new_ = !solver_ || !runs_on_ranks(choice_) || lost_ > setup_in_iterations(choice_.leading);
  if (!is_new_) solver_->relinearise(*next);
  if (is_new_) solver_.reset();
  j_ = std::move(next);
  if (is_new_) set_up(solved);
}

void LinearSteps::set_up(Solved& solved) {
  solver_.reset();  // the old one's memory first
  solver_ = std::make_unique<CoupledSolver>(*j_, choice_);
  solved.setup_seconds += solver_->setup_seconds();
  per_decade_ = lost_ = 0;
}

void LinearSteps::solve_to(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u,
                           Eigen::VectorXd& lambda, Solved& solved) {
  CoupledReport& report = solved.report;
  report = solver_->solve(f, g, solved.tolerance, choice_.max_iterations, u, lambda, stop_);
  if (!report.converged && !is_new_) {
    const double seconds = report.seconds;
    is_new_ = true;
    set_up(solved);
    report = solver_->solve(f, g, solved.tolerance, choice_.max_iterations, u, lambda, stop_);
    report.seconds += seconds;
  }
  const double decades = -std::log10(solved.tolerance);
  const auto n = static_cast<double>(report.residuals.size() - 1);
  if (per_decade_ == 0) per_decade_ = n / decades;
  lost_ += std::max(0.0, n - per_decade_ * decades);
}

double ForcingTerm::next(double norm) {
  constexpr double kGamma = 0.9, kConfirm = 0.1;
  if (first_ == 0) first_ = norm;
  const double ratio = before_ > 0 ? norm / before_ : HUGE_VAL;
  before_ = norm;
  const double enough = norm > 0 ? asked_ * first_ / norm : loosest_;
  const double loosest = std::max(loosest_, std::min(kConfirm, enough));
  return std::min(loosest, std::max(kGamma * ratio * ratio, enough));
}

}  // namespace faultsim
