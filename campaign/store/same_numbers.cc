#include "campaign/store/same_numbers.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::CaseResult;
using faultsim::concat;
using faultsim::StageMetrics;
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

std::vector<std::optional<double>*> later_measures(faultsim::Measures& measures) {
  std::vector<std::optional<double>*> later;
  faultsim::for_each_measure(measures, [&later](const faultsim::Field& field, auto& value) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, std::optional<double>>) {
      if (field.since > 0) later.push_back(&value);
    }
  });
  return later;
}

/// A result from before a measure was added has none, which is not a difference.
void forget_unknown(faultsim::Measures stored, faultsim::Measures& again) {
  const auto before = later_measures(stored), now = later_measures(again);
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (!before[k]->has_value()) now[k]->reset();
  }
}

bool same_stage(const StageMetrics& stored, StageMetrics again) {
  forget_unknown(stored, again);
  for (std::size_t f = 0; f < std::min(stored.faults.size(), again.faults.size()); ++f) {
    forget_unknown(stored.faults[f], again.faults[f]);
  }
  return stored == again;
}

/// Whether an operator is interpolated or a flow result is given is part of a case's identity: a
/// stored result without is one from before this was stored, which is not a difference.
template <typename Value>
bool same_if_stored(const std::optional<Value>& stored, const std::optional<Value>& again) {
  return !stored || stored == again;
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
  if (!std::equal(stored.stages.begin(), stored.stages.end(), again.stages.begin(),
                  again.stages.end(), same_stage) ||
      !same_stage(stored.whole, again.whole)) {
    return "the metrics of the stages";
  }
  if (stored.events != again.events) return "the slip events";
  if (stored.episodes != again.episodes || stored.unexpected != again.unexpected) {
    return "the episodes";
  }
  if (!same_if_stored(stored.surface, again.surface) ||
      !same_if_stored(stored.field_coverage, again.field_coverage)) {
    return "how exact it is";
  }
  const bool same_rest = same(stored.pressure_margin, again.pressure_margin) &&
                         same(stored.max_nucleation_ratio, again.max_nucleation_ratio) &&
                         same(stored.max_penetration, again.max_penetration) &&
                         stored.plane_strain == again.plane_strain &&
                         stored.weakening_resolved == again.weakening_resolved;
  return same_rest ? "" : "the metrics of the case";
}

}  // namespace faultsweep
