#include "simulator/result/result_sentences.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"

namespace faultsim {
namespace {

constexpr double kBar = 1e5;  // Pa

/// At most so many significant digits.
std::string digits(double value, int n) {
  if (!std::isfinite(value)) return "-";
  return formatted("%.*g", n, value + 0.0);
}

}  // namespace

namespace {

/// "F1 slides from step 7 on, first at 2000 m depth, slip 0.05 m"; of a flag that the cells leave
/// open "F1 may slide ...". @pre the flag is set.
std::string fault_slides(const FaultStageMetrics& fault) {
  std::string text = concat(fault.fault, fault.activation_resolved ? " slides" : " may slide");
  if (fault.activation) {
    text += concat(" from step ", fault.activation->step, " on, first at ",
                   digits(fault.activation->depth, 4), " m depth");
  }
  return text + concat(", slip ", digits(fault.max_slip, 3), " m",
                       fault.activation_resolved ? "" : " (the cells do not tell)");
}

}  // namespace

std::string sliding_sentence(const CaseResult& result) {
  const StageMetrics& whole = result.whole;
  std::string text;
  for (const FaultStageMetrics& fault : whole.faults)
    if (fault.activated) text += concat(text.empty() ? "" : "; ", fault_slides(fault));
  if (!text.empty()) return text + ".";
  if (whole.activated) return concat("Slip of ", digits(whole.max_slip, 3), " m: it slides.");
  std::string until;
  if (!in_equilibrium(result.outcome)) {
    if (result.steps.empty()) return "No load step was completed: what slides is not known.";
    until = concat(" up to load step ", result.steps.back().step, ", where the case ended");
  }
  text = concat("Nothing slides", until, ": χ̄ comes to ", digits(whole.chi_bar, 3));
  if (std::isfinite(result.pressure_margin)) {
    text += concat(", and would be 1 after ", digits(result.pressure_margin / kBar, 4),
                   " bar more depletion, extrapolated");
  }
  return text + ".";
}

std::string pressures_text(const SidePressures& sides, double depth) {
  const auto bar = [](double pascal) { return formatted("%.0f", pascal / kBar); };
  std::string text;
  const auto add = [&](const std::string& region, const std::optional<double>& change,
                       const std::optional<double>& absolute) {
    if (!change || !absolute) return;
    text += concat(text.empty() ? "" : ", ", region, " ", bar(*change), " bar (to ", bar(*absolute),
                   " bar)");
  };
  add(sides.region_minus, sides.change_minus, sides.absolute_minus);
  add(sides.region_plus, sides.change_plus, sides.absolute_plus);
  if (text.empty()) text = "no pressure region beside it";
  return concat(text, ", in the fault ", bar(sides.change_in_fault), " bar, at ",
                formatted("%.0f", depth), " m depth");
}

std::vector<std::string> unresolved_sentences(const CaseResult& result) {
  std::vector<std::string> sentences;
  if (result.outcome == Outcome::unresolved_event) {
    sentences.emplace_back(result.weakening_resolved
                               ? "UNRESOLVED: the evidence of a slip event does not hold."
                               : "UNRESOLVED: the size of its slip events depends on the mesh.");
  }
  if (!result.whole.activation_resolved)
    sentences.emplace_back("UNRESOLVED: whether a fault slides depends on the mesh.");
  return sentences;
}

std::string unexpected_sentence(const CaseResult& result) {
  if (!result.unexpected) return "";
  const std::size_t n = result.episodes.size();
  const auto again = static_cast<std::size_t>(result.unexpected->episode - 1);
  const auto before = static_cast<std::size_t>(result.unexpected->after - 1);
  if (again >= n || before >= n) return "UNEXPECTED REACTIVATION.";
  const auto when = [&](std::size_t k) {
    const Episode& e = result.episodes[k];
    return concat(e.stage, ", steps ", e.first_step, "-", e.last_step, " (episode ", k + 1, ")");
  };
  return concat("UNEXPECTED REACTIVATION: fault ", result.episodes[again].fault,
                " slides again in ", when(again), " after its pressure has recovered, having slid",
                " in ", when(before), ".");
}

std::string creep_sentence(const CaseResult& result) {
  std::vector<FaultCreep> most(result.fault_names.size());
  int n_time_steps = 0, n_unresolved = 0;
  double time_error = 0;
  bool creeps = false;
  for (const StepResult& step : result.steps) {
    if (!step.creep) continue;
    creeps = true;
    n_time_steps += step.creep->time_steps;
    n_unresolved += step.creep->time_resolved ? 0 : 1;
    time_error = std::max(time_error, step.creep->time_error);
    most.resize(std::max(most.size(), step.creep->faults.size()));
    for (std::size_t f = 0; f < step.creep->faults.size(); ++f) {
      const FaultCreep& c = step.creep->faults[f];
      most[f].normal_min = std::min(most[f].normal_min, c.normal_min);
      most[f].normal_max = std::max(most[f].normal_max, c.normal_max);
      most[f].shear_max = std::max(most[f].shear_max, c.shear_max);
    }
  }
  if (!creeps) return "";
  std::string text = "salt creeps: it changed tractions";
  for (std::size_t f = 0; f < result.fault_names.size(); ++f) {
    text += concat(f == 0 ? "" : ",", " on ", result.fault_names[f], " by ",
                   digits(most[f].normal_min / kBar, 3), " bar (compression) to ",
                   digits(most[f].normal_max / kBar, 3), " bar (tension) normal and at most ",
                   digits(most[f].shear_max / kBar, 3), " bar in shear");
  }
  text += concat("; ", n_time_steps, " time steps, halving them changes at most ",
                 digits(time_error / kBar, 2), " bar");
  if (n_unresolved > 0) {
    text += concat("; time steps of ", n_unresolved,
                   " load steps are coarser than creep_tolerance asks");
  }
  return text;
}

}  // namespace faultsim
