#include "simulator/contact/step_report.h"

#include <cmath>
#include <sstream>

namespace faultsim {
namespace {

/// Short numbers: these texts are for people.
template <typename... Args>
std::string text(const Args&... args) {
  std::ostringstream out;
  out.precision(6);
  (out << ... << args);
  return out.str();
}

}  // namespace

std::string place(const ContactProblem& problem, int node) {
  const auto& geometry = problem.op.geometry;
  std::string fault = text("node ", node);
  for (const OperatorFault& candidate : geometry.faults) {
    if (node >= candidate.first_node && node < candidate.first_node + candidate.n_nodes) {
      fault = text("fault '", candidate.name, "'");
    }
  }
  const Eigen::Vector3d& at = geometry.nodes[node].position;
  return text(fault, " at x = ", at.x(), " m, y = ", at.y(), " m, depth = ", -at.z(), " m");
}

std::string failure_text(const ContactProblem& problem, const SubStep& sub_step,
                         const SolveCounts& counts, double from, double to) {
  int opening = 0, penetrating = 0, over = 0, against = 0, loaded = 0, worst_node = -1;
  double worst = 0;
  for (int k = 0; k < problem.n_nodes(); ++k) {
    const NodeViolation at = check_node(problem, sub_step, k);
    const double tolerance = sub_step.tolerance[k];
    opening += at.tension > tolerance;
    penetrating += at.penetration > tolerance;
    over += at.over_limit > tolerance;
    against += at.below_limit > tolerance || at.misaligned > tolerance;
    loaded += at.open_traction > tolerance;
    const double relative = at.over(tolerance);
    if (worst_node < 0 || (!std::isnan(worst) && !(relative <= worst))) {
      worst_node = k;
      worst = relative;
    }
  }
  std::string reason =
      text("not in equilibrium between load factors ", from, " and ", to, " of the step after ",
           counts.active_set_passes, " active sets and ", counts.wasted_newton_iterations,
           " wasted iterations: ", opening, " nodes open in stick, ", penetrating, " penetrate, ",
           over, " stick or slip over the limit, ", against, " slip against their traction, ",
           loaded, " open under traction");
  if (worst_node < 0) return reason;
  const ContactNode& node = problem.nodes[worst_node];
  const double gap = sub_step.start->jump[node.dof[0]] + sub_step.increment[node.dof[0]];
  return reason +
         text("; worst: ", place(problem, worst_node), " (", to_string(sub_step.state[worst_node]),
              "), t'_N = ", sub_step.traction[node.dof[0]],
              " Pa, |t'_T| = ", shear_part(node, sub_step.traction).norm(), " Pa, g_N = ", gap,
              " m, |slip of the step| = ", shear_part(node, sub_step.increment).norm(), " m, ",
              worst, " times its tolerance");
}

std::string instability_text(const ContactProblem& problem, const SubStep& sub_step,
                             const StabilityReport& stability, double from, double to) {
  const auto i = static_cast<std::size_t>(stability.node);
  const ContactNode& node = problem.nodes[i];
  return text("slip weakening outruns the elastic stiffness between load factors ", from, " and ",
              to, " of the step on ", place(problem, stability.node),
              " (t'_N = ", sub_step.start->traction[node.dof[0]], " Pa, ", stability.n_slipping,
              " slipping nodes, weakening over stiffness ", stability.ratio,
              " at that node alone)");
}

std::string lost_cohesion_text(const ContactProblem& problem, const SubStep& sub_step, double from,
                               double to) {
  int n_slipping = 0, largest = 0;
  double slip = -1;
  for (int k = 0; k < problem.n_nodes(); ++k) {
    if (!loses_cohesion(problem, sub_step, k)) continue;
    ++n_slipping;
    const double here = shear_part(problem.nodes[k], sub_step.increment).norm();
    if (here <= slip) continue;
    slip = here;
    largest = k;
  }
  return text("slip ends the cohesion of ", n_slipping, " nodes between load factors ", from,
              " and ", to, " of the step, most on ", place(problem, largest),
              ": their strength drops and equilibrium jumps");
}

std::string too_many_jumps_text(std::size_t n_jumps, double from) {
  return text(n_jumps, " instabilities were followed up to load factor ", from,
              " of the step, and there are more; use smaller load steps or a finer mesh, or raise "
              "/numerics/max_events");
}

}  // namespace faultsim
