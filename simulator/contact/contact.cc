#include "simulator/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/contact/contact_problem.h"
#include "simulator/contact/jump_follower.h"
#include "simulator/contact/step_cutter.h"
#include "simulator/contact/step_report.h"
#include "simulator/contact/sub_step_solver.h"

namespace faultsim {

/// A load step in halves of halves. Position and width are in units of the smallest sub-step.
struct ContactSolver::Impl {
  Impl(const FaultOperator& op, const ContactLaws& laws, const ContactOptions& given,
       const ContactWatch& watch)
      : options(given), solver(op, laws, options, watch), follower(solver) {
    follows = std::ranges::any_of(laws, [](const CoulombLaw& law) { return law.damping > 0; });
    most_cuts = options.max_step_cuts;
    // An onset is a matter of the load factor; other trouble is not helped by ever smaller steps.
    if (follows && solver.problem().may_jump) {
      most_cuts =
          std::max(most_cuts, static_cast<int>(std::ceil(std::log2(1 / options.onset_tolerance))));
    }
  }

  double factor(int position) const { return position * (1.0 / (1 << most_cuts)); }
  void walk(const LoadPath& path, ContactReport& report);
  bool sub_step(const LoadPath& path, int position, int width, SolveCounts& counts);
  bool jump(const LoadPath& path, int position, ContactReport& report);
  void explain(int position, ContactReport& report) const;

  ContactOptions options;
  SubStepSolver solver;
  JumpFollower follower;
  bool follows = false;
  int most_cuts = 0;
  Attempt failure = Attempt::failed;  ///< how the last sub-step ended.
  ContactState rolling;               ///< the state between sub-steps.
};

ContactSolver::ContactSolver(const FaultOperator& op, const ContactLaws& laws,
                             const ContactOptions& options, const ContactWatch& watch)
    : impl_(std::make_unique<Impl>(op, laws, options, watch)) {}
ContactSolver::~ContactSolver() = default;

ContactReport ContactSolver::solve_step(const Eigen::VectorXd& before, const Eigen::VectorXd& after,
                                        ContactState& state) {
  Impl& impl = *impl_;
  const auto n = impl.solver.problem().n_dofs();
  FAULTSIM_DEMAND(before.size() == n && after.size() == n && state.jump.size() == n, "n_dofs ", n,
                  " before ", before.size(), " after ", after.size());
  ContactReport report;
  const LoadPath path{before, after};
  impl.solver.begin(path, {}, state);
  const bool rests = impl.solver.rest();
  if (rests || impl.solver.attempt(impl.most_cuts == 0) == Attempt::converged) {
    impl.solver.commit(state);
    report.counts = {impl.solver.iterations(), impl.solver.passes(), 1, 0};
    report.outcome = Outcome::converged;
    return report;
  }
  report.counts.active_set_passes = impl.solver.passes();
  report.counts.wasted_newton_iterations = impl.solver.iterations();
  impl.rolling = state;
  impl.walk(path, report);
  if (in_equilibrium(report.outcome)) {
    std::swap(state, impl.rolling);
  }
  return report;
}

/// One sub-step of the cut step. @returns whether rolling advanced.
bool ContactSolver::Impl::sub_step(const LoadPath& path, int position, int width,
                                   SolveCounts& counts) {
  solver.begin(path, {factor(position), factor(position + width), 0}, rolling);
  if (!solver.rest()) {
    const bool last = width == 1 && !follows;
    failure = solver.attempt(last);
    const bool good = failure == Attempt::converged;
    counts.active_set_passes += solver.passes();
    (good ? counts.newton_iterations : counts.wasted_newton_iterations) += solver.iterations();
    if (!good) return false;
  }
  solver.commit(rolling);
  ++counts.sub_steps;
  return true;
}

/// In parts, and where even the smallest one fails by following a jump.
void ContactSolver::Impl::walk(const LoadPath& path, ContactReport& report) {
  const bool arrived = walk_in_parts(
      most_cuts,
      [&](int position, int width) { return sub_step(path, position, width, report.counts); },
      [&](int position) {
        if (follows && jump(path, position, report)) return true;
        explain(position, report);
        return false;
      });
  if (arrived) report.outcome = report.jumps.empty() ? Outcome::converged : Outcome::event;
}

/// Follows the jump in the smallest sub-step at position. A jump that starts where the last one
/// ended belongs to it.
bool ContactSolver::Impl::jump(const LoadPath& path, int position, ContactReport& report) {
  if (static_cast<int>(report.jumps.size()) >= options.max_jumps) return false;
  const int budget = options.max_iterations - report.counts.newton_iterations -
                     report.counts.wasted_newton_iterations;
  JumpFollower::Report followed =
      follower.follow(path, factor(position), factor(position + 1), budget, rolling);
  report.counts += followed.counts;
  ++report.counts.sub_steps;
  if (!followed.jump) return followed.arrived;
  if (!report.jumps.empty() && report.jumps.back().load_after >= followed.jump->load_before) {
    report.jumps.back().append(*followed.jump);
  } else {
    report.jumps.push_back(std::move(*followed.jump));
  }
  return followed.arrived;
}

void ContactSolver::Impl::explain(int position, ContactReport& report) const {
  const double from = factor(position);
  const double to = factor(position + 1);
  const StabilityReport& stable = solver.stability_report();
  const ContactProblem& problem = solver.problem();
  const bool loses_cohesion = !follows && failure == Attempt::lost_cohesion;
  const bool weakens = stable.checked || loses_cohesion || !report.jumps.empty();
  report.outcome = weakens ? Outcome::unstable : Outcome::unconverged;
  if (static_cast<int>(report.jumps.size()) >= options.max_jumps) {
    report.reason = too_many_jumps_text(report.jumps.size(), from);
  } else if (loses_cohesion) {
    report.reason = lost_cohesion_text(problem, solver.sub_step(), from, to);
  } else if (stable.checked) {
    report.reason = instability_text(problem, solver.sub_step(), stable, from, to);
  } else {
    report.reason = failure_text(problem, solver.sub_step(), report.counts, from, to);
  }
  const std::string search = trace_summary(solver.trace());
  if (!search.empty()) report.reason += "; last search: " + search;
}

}  // namespace faultsim
