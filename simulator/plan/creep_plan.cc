#include "simulator/plan/creep_plan.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/initial_state/load_times.h"

namespace faultsim {
namespace {

/// Step lengths closer than this, relatively, are one: year/12 and (year/4)/3 differ in rounding.
constexpr double kSameLength = 1e-9;

/// Descending, each once.
std::vector<double> distinct(std::vector<double> lengths) {
  std::sort(lengths.rbegin(), lengths.rend());
  const auto is_same = [](double longer, double length) {
    return longer - length <= kSameLength * longer;
  };
  drop_repeated(lengths, is_same);
  return lengths;
}

/// "75.2 days", "18 years": four digits at the most.
std::string duration_text(double seconds) {
  struct Unit {
    const char* name;
    double seconds;
  };
  constexpr Unit kUnits[] = {{"year", 31557600}, {"day", 86400}, {"hour", 3600}, {"s", 1}};
  const Unit* unit = kUnits;
  while (unit->seconds > 1 && seconds < unit->seconds * (1 - 1e-9)) ++unit;
  const std::string number = formatted("%.4g", seconds / unit->seconds);
  const bool is_many = unit->seconds > 1 && number != "1";
  return number + " " + unit->name + (is_many ? "s" : "");
}

std::string digits(double value) { return formatted("%.3g", value); }

std::string megapascals(double pascals) { return digits(pascals / 1e6) + " MPa"; }

std::string relaxation_text(const CreepEstimate& estimate) {
  return concat("relaxation time ", duration_text(estimate.relaxation_time), ", history ",
                duration_text(estimate.duration), ": ", digits(100 * estimate.relaxed_share),
                " % relaxed");
}

}  // namespace

Reduction plan_creep_off(const Scene& scene, const CreepEstimate& estimate) {
  const double limit = scene.numerics.creep_tolerance / 10;
  const Switch creep = scene.numerics.creep;
  const bool is_small = estimate.bound && *estimate.bound < limit;
  const std::string tenth = "a tenth of creep_tolerance, " + megapascals(limit);
  Reduction r{"creep_off", false, relaxation_text(estimate), "", "/numerics/creep", {}};
  r.applied = creep == Switch::off || (creep == Switch::automatic && is_small);
  r.bound = !estimate.bound ? "not bounded, as a face is translated"
                            : "moves fault tractions by less than " + megapascals(*estimate.bound);
  if (creep == Switch::off) {
    r.reason = "switched off; " + r.reason;
  } else if (creep == Switch::on) {
    r.reason = "creep is switched on; " + r.reason;
  } else if (is_small) {
    r.bound += ", below " + tenth;
  } else if (estimate.bound) {
    r.reason += concat("; may move fault tractions by up to ", megapascals(*estimate.bound),
                       ", more than ", tenth);
  } else {
    r.reason += "; its effect on faults is not bounded, as a face is translated";
  }
  return r;
}

std::vector<double> creep_rungs(const Scene& scene) {
  const Numerics& numerics = scene.numerics;
  std::vector<double> load_steps, lengths;
  for (const StepEnd& step : step_ends(scene)) load_steps.push_back(step.length);
  for (const double load_step : distinct(std::move(load_steps))) {
    if (numerics.creep_time_step > 0) {
      const double ratio = load_step / numerics.creep_time_step;
      lengths.push_back(load_step / std::max(1.0, std::ceil(ratio - kSameLength)));
      continue;
    }
    for (int k = 0; k <= numerics.creep_refinements; ++k) {
      lengths.push_back(std::ldexp(load_step, -k));
    }
  }
  return distinct(std::move(lengths));
}

std::string creep_text(const CreepPlan& creep) {
  if (!creep.active) return "";
  std::string steps = joined(creep.rungs, ", ", duration_text);
  return concat("creep: steps of ", steps, "; ", creep.rungs.size() + 1,
                " operators with the elastic one\n");
}

}  // namespace faultsim
