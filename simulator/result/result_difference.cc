#include "simulator/result/result_difference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <tuple>
#include <utility>

#include "simulator/common/errors.h"
#include "simulator/common/text.h"

namespace faultsim {
namespace {

using Sentences = std::vector<std::string>;

/// Three significant digits, without an exponent where numbers are of a size that people say.
std::string three(double value) {
  constexpr double kLeast = 999.5, kMost = 1e6;
  const double size = std::abs(value);
  return formatted(size >= kLeast && size < kMost ? "%.0f" : "%.3g", value + 0.0);
}
std::string slip_text(double metres) {
  return std::abs(metres) < 1 ? three(metres * 1e3) + " mm" : three(metres) + " m";
}
std::string bar_text(double pascal) { return three(pascal / 1e5) + " bar"; }

// What slides, or opens -------------------------------------------------------------------------

enum class Flag { no, yes, undecided };

/// Something that faults do.
struct Deed {
  const char *does, *do_it;  ///< "slides", "slide".
  Flag (*flag)(const FaultStageMetrics&);
  std::optional<FaultOnset> FaultStageMetrics::*onset;
};
const Deed kSliding = {"slides", "slide",
                       [](const FaultStageMetrics& m) {
                         if (!m.activation_resolved) return Flag::undecided;
                         return m.activated ? Flag::yes : Flag::no;
                       },
                       &FaultStageMetrics::activation};
const Deed kOpening = {"opens", "open",
                       [](const FaultStageMetrics& m) { return m.opens ? Flag::yes : Flag::no; },
                       &FaultStageMetrics::opening};

/// A fault in a stage, or in all, of one of the two.
struct Part {
  const CaseResult& result;
  const FaultStageMetrics& fault;
};

const FaultStageMetrics* fault_of(const StageMetrics& stage, const std::string& name) {
  const auto found = std::ranges::find(stage.faults, name, &FaultStageMetrics::fault);
  return found == stage.faults.end() ? nullptr : &*found;
}

/// "west at Δp -140 bar": of the side that leads.
std::string pressure_at(const SidePressures& sides) {
  const std::optional<double> change = leading_change(sides);
  if (!change) return "Δp in the fault " + bar_text(sides.change_in_fault);
  return concat(change == sides.change_minus ? sides.region_minus : sides.region_plus, " at Δp ",
                bar_text(*change));
}

/// "step 12 (gas_storage, west at Δp -140 bar)".
std::string onset_at(const Part& part, const Deed& deed) {
  const std::optional<FaultOnset>& onset = part.fault.*deed.onset;
  if (!onset) return "an unknown step";
  const auto step = std::ranges::find(part.result.steps, onset->step, &StepResult::step);
  const std::string stage = step == part.result.steps.end() ? "" : step->stage + ", ";
  return concat("step ", onset->step, " (", stage, pressure_at(onset->pressures), ")");
}

/// The history of `result` ends before what begins in the other part.
bool ends_before(const CaseResult& result, const Part& other, const Deed& deed) {
  const std::optional<FaultOnset>& onset = other.fault.*deed.onset;
  if (in_equilibrium(result.outcome) || !onset) return false;
  const int end = result.failed_step.value_or(result.steps.empty() ? 0 : result.steps.back().step);
  return end <= onset->step;
}

/// What changes of a deed; "" where nothing does. @param where  "", or " in gas_storage".
std::string change_of(const Deed& deed, const Part& was, const Part& is, const std::string& where) {
  const Flag from = deed.flag(was.fault), to = deed.flag(is.fault);
  const std::string& name = is.fault.fault;
  if (from == to) {
    if (from != Flag::yes || onset_at(was, deed) == onset_at(is, deed)) return "";
    return concat(name, " ", deed.does, where, " from load ", onset_at(is, deed), " instead of ",
                  onset_at(was, deed), ".");
  }
  std::string before = concat("before the change it did, from load ", onset_at(was, deed));
  if (from == Flag::no) before = "before the change it did not";
  if (from == Flag::undecided) before = "before the change its cells could not tell";
  if (to == Flag::undecided)
    return concat("Whether ", name, " ", deed.does, where,
                  " cannot be decided on these cells: ", before, ".");
  if (to == Flag::yes) {
    if (from == Flag::no && ends_before(was.result, is, deed)) before += " come so far";
    return concat(name, " ", deed.does, where, " now, from load ", onset_at(is, deed), ": ", before,
                  ".");
  }
  if (!in_equilibrium(is.result.outcome))
    return concat(name, " does not ", deed.do_it, where, " before the history ends: ", before,
                  ends_before(is.result, was, deed) ? ", which is not reached now." : ".");
  return from == Flag::yes ? concat(name, " no longer ", deed.does, where, ": ", before, ".")
                           : concat(name, " does not ", deed.do_it, where, " now: ", before, ".");
}

bool holds_onset(const StageMetrics& stage, const FaultStageMetrics& whole, const Deed& deed) {
  const std::optional<FaultOnset>& onset = whole.*deed.onset;
  return onset && stage.first_step <= onset->step && onset->step <= stage.last_step;
}

/// The stage of the same name, the k-th of them as it is the k-th; nullptr where there is none.
const StageMetrics* same_stage(const CaseResult& before, const CaseResult& after, std::size_t at) {
  const auto is_it = [&](const StageMetrics& one) { return one.stage == after.stages[at].stage; };
  auto k = std::count_if(after.stages.begin(),
                         after.stages.begin() + static_cast<std::ptrdiff_t>(at), is_it);
  for (const StageMetrics& stage : before.stages)
    if (is_it(stage) && k-- == 0) return &stage;
  return nullptr;
}

/// Of the whole case, then of stages beside those in which it begins.
Sentences deeds(const Deed& deed, const CaseResult& before, const CaseResult& after) {
  Sentences flips, shifts, stages;
  for (const FaultStageMetrics& is : after.whole.faults) {
    const FaultStageMetrics* was = fault_of(before.whole, is.fault);
    if (was == nullptr) continue;
    const bool flips_over = deed.flag(*was) != deed.flag(is);
    (flips_over ? flips : shifts).push_back(change_of(deed, {before, *was}, {after, is}, ""));
    for (std::size_t k = 0; k < after.stages.size(); ++k) {
      const StageMetrics *now = &after.stages[k], *then = same_stage(before, after, k);
      if (then == nullptr || holds_onset(*now, is, deed) || holds_onset(*then, *was, deed))
        continue;
      const FaultStageMetrics *a = fault_of(*then, is.fault), *b = fault_of(*now, is.fault);
      if (a != nullptr && b != nullptr)
        stages.push_back(change_of(deed, {before, *a}, {after, *b}, " in " + now->stage));
    }
  }
  for (Sentences* more : {&shifts, &stages}) flips.insert(flips.end(), more->begin(), more->end());
  std::erase(flips, "");
  constexpr std::size_t kMost = 5;
  if (flips.size() > kMost) {
    const std::size_t n = flips.size() - kMost;
    flips.resize(kMost);
    flips.push_back(concat(n, " more differences of what ", deed.does, n == 1 ? " is" : " are",
                           " not listed."));
  }
  return flips;
}

// The rest ---------------------------------------------------------------------------------------

std::string ending(const CaseResult& result) {
  return concat(result.failed_step ? concat("at load step ", *result.failed_step, " ") : "", "(",
                to_string(result.outcome), result.reason.empty() ? "" : ": ", result.reason, ")");
}

std::string outcome_change(const CaseResult& before, const CaseResult& after) {
  const bool was = in_equilibrium(before.outcome), is = in_equilibrium(after.outcome);
  if (was && is) return "";
  if (was)
    return concat("The history ends early now, ", ending(after),
                  ": before the change it came to its end.");
  if (is)
    return concat("The history comes to its end now: before the change it ended early, ",
                  ending(before), ".");
  if (ending(before) == ending(after)) return "";
  return concat("The history ends early, ", ending(after), " instead of ", ending(before), ".");
}

std::string reactivation_change(const CaseResult& before, const CaseResult& after) {
  const auto fault = [](const CaseResult& result) -> std::string {
    if (!result.unexpected) return "";
    const auto k = static_cast<std::size_t>(result.unexpected->episode - 1);
    return k < result.episodes.size() ? result.episodes[k].fault : "a fault";
  };
  const std::string was = fault(before), is = fault(after);
  if (was == is) return "";
  if (was.empty())
    return concat("Unexpected reactivation of ", is, " now: before the change there was none.");
  if (is.empty()) return concat("No unexpected reactivation now: before the change of ", was, ".");
  return concat("Unexpected reactivation first of ", is, " instead of ", was, ".");
}

const SlipEvent* largest_event(const CaseResult& result) {
  const auto largest = std::ranges::max_element(result.events, {}, &SlipEvent::moment);
  return largest == result.events.end() ? nullptr : &*largest;
}

/// "Mw 2.31 on F2 in load step 12".
std::string event_text(const CaseResult& result, const SlipEvent& event) {
  const std::string size = event.magnitude ? "Mw " + three(*event.magnitude)
                                           : concat("M0 ", formatted("%.3g", event.moment), " N m",
                                                    result.plane_strain ? " per m of strike" : "");
  return concat(size, " on ", event.fault, " in load step ", event.step,
                event.resolved ? "" : " (unresolved: its size depends on the mesh)");
}

std::string events_change(const CaseResult& before, const CaseResult& after) {
  const std::size_t was = before.events.size(), is = after.events.size();
  const auto said = [](const CaseResult& result) {
    const SlipEvent* largest = largest_event(result);
    return largest == nullptr ? "" : event_text(result, *largest);
  };
  const auto count = [](std::size_t n) {
    return concat(n, n == 1 ? " slip event" : " slip events");
  };
  const std::string then = said(before), now = said(after);
  if (was == is && then == now) return "";
  if (was == 0)
    return concat(count(is), " now, the largest ", now, ": before the change there was none.");
  if (is == 0)
    return concat("No slip event now: before the change ", count(was), ", the largest ", then, ".");
  const std::string sizes = then == now ? concat("the largest ", now, " as before")
                                        : concat("the largest ", now, " instead of ", then);
  return concat(count(is), was == is ? ", as before" : concat(" instead of ", was), ", ", sizes,
                ".");
}

/// "Largest χ̄: of F2 0.91 instead of 0.84": of each fault that changes by more than `least`, those
/// that change most first. @param text  of a value.
template <typename Text>
std::string values_change(const char* what, const CaseResult& before, const CaseResult& after,
                          double Measures::*value, double least, const Text& text) {
  std::vector<std::pair<double, std::string>> changes;
  for (const FaultStageMetrics& is : after.whole.faults) {
    const FaultStageMetrics* was = fault_of(before.whole, is.fault);
    if (was == nullptr) continue;
    const double change = std::abs(is.*value - was->*value);
    const std::string then = text(was->*value), now = text(is.*value);
    if (!(change >= least) || then == now) continue;
    changes.emplace_back(change, concat("of ", is.fault, " ", now, " instead of ", then));
  }
  if (changes.empty()) return "";
  std::ranges::stable_sort(changes, std::greater(), &std::pair<double, std::string>::first);
  constexpr std::size_t kMost = 3;
  const std::size_t n = std::min(kMost, changes.size());
  std::string said = concat("Largest ", what, ": ");
  for (std::size_t k = 0; k < n; ++k) said += (k == 0 ? "" : ", ") + changes[k].second;
  if (const std::size_t more = changes.size() - n; more > 0)
    said += concat("; ", more, more == 1 ? " other changes" : " others change", " by no more");
  return said + ".";
}

/// The least differences that mean something, of χ̄ and of slip (m).
struct Least {
  double chi = 1e-3, slip = 1e-5;
};
Least least_of(const CaseResult& before, const CaseResult& after) {
  double chi = 0, slip = 0;
  for (const CaseResult* one : {&before, &after}) {
    if (!one->surface) continue;
    chi += one->surface->chi_bar.value_or(0);
    slip += one->surface->largest_slip.value_or(0) * one->whole.max_slip;
  }
  Least least;
  return {std::max(least.chi, chi), std::max(least.slip, slip)};
}

std::string margin_change(const CaseResult& before, const CaseResult& after) {
  const double was = before.pressure_margin, is = after.pressure_margin;
  if (!std::isfinite(was) || !std::isfinite(is) || bar_text(was) == bar_text(is)) return "";
  return concat("Extrapolated, χ̄ would be 1 after ", bar_text(is), " more depletion instead of ",
                bar_text(was), ".");
}

Sentences undecided(const CaseResult& before, const CaseResult& after) {
  Sentences said;
  for (const FaultStageMetrics& is : after.whole.faults) {
    const FaultStageMetrics* was = fault_of(before.whole, is.fault);
    if (was != nullptr && kSliding.flag(*was) == Flag::undecided &&
        kSliding.flag(is) == Flag::undecided)
      said.push_back(concat("Whether ", is.fault,
                            " slides cannot be decided on these cells, as before the change."));
  }
  return said;
}

/// What the two cannot be compared in.
Sentences kinds(const CaseResult& before, const CaseResult& after) {
  Sentences said;
  for (const auto& [one, other, words] :
       {std::tuple(&after, &before, " was not there before the change."),
        std::tuple(&before, &after, " was there before the change and is not now.")}) {
    for (const std::string& name : one->fault_names)
      if (std::ranges::find(other->fault_names, name) == other->fault_names.end())
        said.push_back(concat("Fault ", name, words));
  }
  if (before.plane_strain != after.plane_strain)
    said.emplace_back(after.plane_strain
                          ? "It is in plane strain now, and was in three dimensions."
                          : "It is in three dimensions now, and was in plane strain.");
  const auto interpolated = [](const CaseSurface& surface) {
    return concat("interpolated between ", surface.n_operators, " exact ones",
                  surface.chi_bar ? concat(" (χ̄ off by up to ", three(*surface.chi_bar), ")") : "");
  };
  if (after.surface && !before.surface)
    said.push_back(
        concat("The operator is ", interpolated(*after.surface), " now, and was exact."));
  if (before.surface && !after.surface)
    said.push_back(
        concat("The operator is exact now, and was ", interpolated(*before.surface), "."));
  return said;
}

}  // namespace

std::vector<std::string> difference_sentences(const CaseResult& before, const CaseResult& after) {
  if (!before.identity.empty() && before.identity == after.identity)
    return {"Nothing changes: it is the same case."};
  const Least least = least_of(before, after);
  Sentences said = {outcome_change(before, after)};
  const auto add = [&](Sentences more) {
    said.insert(said.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
  };
  add(deeds(kSliding, before, after));
  add(deeds(kOpening, before, after));
  add({reactivation_change(before, after), events_change(before, after),
       values_change("χ̄", before, after, &Measures::chi_bar, least.chi, three),
       values_change("slip", before, after, &Measures::max_slip, least.slip, slip_text),
       margin_change(before, after)});
  std::erase(said, "");
  if (said.empty())
    said.push_back(concat("Nothing changes beyond ", three(least.chi), " in the largest χ̄ and ",
                          slip_text(least.slip), " in the largest slip of a fault."));
  add(undecided(before, after));
  add(kinds(before, after));
  return said;
}

}  // namespace faultsim
