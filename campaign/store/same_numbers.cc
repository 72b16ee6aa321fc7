#include "campaign/store/same_numbers.h"

#include <cmath>

#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;
using faultsim::StepResult;

namespace {

/// A margin that is not given is NaN.
bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool same_creep(const StepResult& a, const StepResult& b) {
  if (!a.creep || !b.creep) return !a.creep && !b.creep;
  return a.creep->time_steps == b.creep->time_steps && a.creep->time_error == b.creep->time_error &&
         a.creep->time_resolved == b.creep->time_resolved && a.creep->faults == b.creep->faults;
}

bool same_step(const StepResult& a, const StepResult& b) {
  const bool same_course = a.step == b.step && a.stage == b.stage && a.time == b.time &&
                           a.pressure_change == b.pressure_change && a.outcome == b.outcome &&
                           a.reason == b.reason && a.n_stick == b.n_stick && a.n_slip == b.n_slip &&
                           a.n_open == b.n_open;
  // A step that did not end in equilibrium has no metrics in the store.
  return same_course &&
         (!faultsim::in_equilibrium(a.outcome) || (a.faults == b.faults && same_creep(a, b)));
}

}  // namespace

std::string first_difference(const CaseResult& stored, const CaseResult& again) {
  if (stored.outcome != again.outcome || stored.reason != again.reason ||
      stored.failed_step != again.failed_step) {
    return "the outcome";
  }
  if (stored.steps.size() != again.steps.size()) return "the number of load steps";
  for (std::size_t k = 0; k < stored.steps.size(); ++k) {
    if (!same_step(stored.steps[k], again.steps[k])) {
      return concat("load step ", stored.steps[k].step, " (", stored.steps[k].stage, ")");
    }
  }
  if (stored.stages != again.stages || stored.whole != again.whole) {
    return "the metrics of the stages";
  }
  if (stored.events != again.events) return "the slip events";
  if (stored.episodes != again.episodes || stored.unexpected != again.unexpected) {
    return "the episodes";
  }
  const bool same_rest = same(stored.pressure_margin, again.pressure_margin) &&
                         same(stored.max_nucleation_ratio, again.max_nucleation_ratio) &&
                         same(stored.max_penetration, again.max_penetration) &&
                         stored.plane_strain == again.plane_strain &&
                         stored.weakening_resolved == again.weakening_resolved;
  return same_rest ? "" : "the metrics of the case";
}

}  // namespace faultsweep
