#include "simulator/app/screen.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "simulator/common/text.h"
#include "simulator/result/result_sentences.h"

namespace faultsim {
namespace {

std::string bar(double pascal) { return formatted("%.0f", pascal / 1e5); }

constexpr std::size_t kScreenWidth = 100;
constexpr std::size_t kRegionWidth = 8, kFaultWidth = 8;

/// The columns that stay beside those of regions and faults.
std::size_t fixed_width(bool wide) { return wide ? 82 : 60; }

/// As many faults as fit; of more, the column after them has the largest index of the others.
std::size_t n_fault_columns(std::size_t n_regions, std::size_t n_faults, bool wide) {
  const std::size_t taken = fixed_width(wide) + n_regions * kRegionWidth;
  if (wide || taken + n_faults * kFaultWidth <= kScreenWidth) return n_faults;
  return taken + 2 * kFaultWidth > kScreenWidth ? 0 : (kScreenWidth - taken) / kFaultWidth - 1;
}

/// One column, the most depleted region, where they would take the faults' place.
bool shows_regions(std::size_t n_regions, bool wide) { return wide || n_regions <= 4; }

/// Of temperature: all regions where there is room, else the largest change of all.
std::size_t n_temperature_columns(bool has_temperatures, std::size_t n_regions, bool wide) {
  return !has_temperatures ? 0 : wide ? n_regions : 1;
}

/// '*' where the fault slides, '?' where that depends on the cells.
char mark(const FaultMetrics& fault) {
  if (!fault.activation_resolved) return '?';
  return fault.activated ? '*' : ' ';
}

/// Units of what is per metre of strike in plane strain.
const char* area_unit(const CaseResult& result) { return result.plane_strain ? "m2/m" : "m2"; }
const char* moment_unit(const CaseResult& result) { return result.plane_strain ? "N m/m" : "N m"; }

std::string events_text(const CaseResult& result) {
  if (result.events.empty()) return "";
  std::string text = formatted("slip events: %zu (! in the table)\n", result.events.size());
  constexpr std::size_t kShown = 20;
  for (const SlipEvent& e :
       std::span(result.events).first(std::min(result.events.size(), kShown))) {
    text += formatted("  step %d: fault %s jumps at %s, nucleus %.3g m, slip %.1f mm, M0 %.3g %s",
                      e.step, e.fault.c_str(), pressures_text(e.pressures, e.depth).c_str(),
                      e.nucleation_length, e.max_slip * 1e3, e.moment, moment_unit(result));
    if (e.magnitude) text += formatted(", Mw %.1f", *e.magnitude);
    if (!e.resolved) text += ", NOT RESOLVED: its size depends on the mesh";
    if (!e.evidence_holds) text += ", EVIDENCE DOES NOT HOLD";
    text += "\n";
  }
  if (result.events.size() > kShown) text += "  the rest are in result.json\n";
  return text;
}

std::string steps_text(const Episode& e) {
  return formatted("%s, steps %d-%d", e.stage.c_str(), e.first_step, e.last_step);
}

std::string episodes_text(const CaseResult& result) {
  std::string text;
  int number = 0;
  for (const Episode& e : result.episodes) {
    text += formatted("episode %d: fault %s slides in %s, from %s%s, slip %.1f mm, M0 %.3g %s\n",
                      ++number, e.fault.c_str(), steps_text(e).c_str(),
                      pressures_text(e.pressures, e.depth).c_str(),
                      e.after_recovery ? ", its pressure having recovered" : "", e.max_slip * 1e3,
                      e.moment, moment_unit(result));
  }
  return text;
}

/// Which fault is the first to do something, when and beside which pressures: "OPENS: fault F2 from
/// load step 7 (gas_storage), west …".
std::string onset_text(const CaseResult& result, const char* what, const std::string& fault,
                       const FaultOnset& onset) {
  std::string stage;
  for (const StepResult& step : result.steps) {
    if (step.step == onset.step) stage = step.stage;
  }
  std::string text =
      formatted("%s: fault %s from load step %d (%s), %s", what, fault.c_str(), onset.step,
                stage.c_str(), pressures_text(onset.pressures, onset.depth).c_str());
  if (onset.change_before)
    text += formatted(
        "; searched within the step: between %.2f and %.2f bar", *onset.change_before / 1e5,
        leading_change(onset.pressures).value_or(onset.pressures.change_in_fault) / 1e5);
  return text;
}

/// What slides and opens, what comes unexpectedly, and what depends on the mesh (docs/words.md).
std::string whole_text(const CaseResult& result) {
  const StageMetrics& whole = result.whole;
  std::string text = sliding_sentence(result) + (whole.activated ? " (* in the table)\n" : "\n");
  if (const FaultOnset* onset = first_activation(whole)) {
    text += onset_text(result, "first to slide", whole.activated_fault, *onset) + "\n";
  } else if (whole.slips) {
    text += "Nodes slip, over less than the activation length.\n";
  }
  if (const FaultOnset* onset = first_opening(whole)) {
    text += onset_text(result, "OPENS", whole.opened_fault, *onset) +
            formatted(", up to %.4g %s\n", whole.open_area, area_unit(result));
  }
  std::vector<std::string> more = unresolved_sentences(result);
  if (!whole.activation_resolved) more.back() += " (? in the table)";
  if (const std::string again = unexpected_sentence(result); !again.empty()) more.push_back(again);
  for (const std::string& sentence : more) text += sentence + "\n";
  return text;
}

/// "F2 slides from step 7, slip 12.3 mm; ", per fault that does anything in the stage.
std::string stage_text(const CaseResult& result, const StageMetrics& stage) {
  std::string text = formatted(
      "  %-22.22s steps %d-%d: window chi %.3f, slip within the stage %.2f mm, sliding area "
      "%.4g %s, M0 %.3g %s\n",
      stage.stage.c_str(), stage.first_step, stage.last_step, stage.chi_bar, stage.max_slip * 1e3,
      stage.activated_area, area_unit(result), stage.moment, moment_unit(result));
  for (const FaultStageMetrics& fault : stage.faults) {
    if (!fault.slips && !fault.opens) continue;
    text += formatted("    %s %s, %.2f mm", fault.fault.c_str(),
                      fault.activated ? "slides" : "slips", fault.max_slip * 1e3);
    if (!fault.activation_resolved) text += " (whether it slides is unresolved)";
    if (fault.activation) {
      text +=
          formatted(", from step %d, %s", fault.activation->step,
                    pressures_text(fault.activation->pressures, fault.activation->depth).c_str());
    }
    if (fault.n_events > 0) text += formatted(", jumps %d times", fault.n_events);
    if (fault.opening) {
      text += formatted(", opens from step %d, up to %.4g %s", fault.opening->step, fault.open_area,
                        area_unit(result));
    }
    text += "\n";
  }
  return text;
}

std::string coupled_text(const CaseResult& result) {
  if (!result.coupled) return "";
  const CaseCoupled& c = *result.coupled;
  if (c.schur == "columns") {
    std::size_t n_solves = 0;
    for (const StepResult& step : result.steps)
      n_solves += step.coupled ? step.coupled->krylov_iterations.size() : 0;
    return formatted(
        "coupled path (%s, columns of H): %d displacements, %d jumps; %zu solves in %d iterations\n"
        "of conjugate gradients, at most %d in one; set-up %.1f s, solves %.1f s of the "
        "processor\n",
        c.leading.c_str(), c.n_displacements, c.n_multipliers, n_solves, c.krylov_iterations,
        c.most_krylov_iterations, c.setup_seconds, c.solve_seconds);
  }
  return formatted(
      "coupled path (%s, %s): %d displacements, %d multipliers; %d iterations of GMRES in "
      "%d of\nNewton, at most %d in one; set-up %.1f s, solve %.1f s of the processor\n",
      c.leading.c_str(), c.schur.c_str(), c.n_displacements, c.n_multipliers, c.krylov_iterations,
      result.counts.newton_iterations + result.counts.wasted_newton_iterations,
      c.most_krylov_iterations, c.setup_seconds, c.solve_seconds);
}

}  // namespace

ScreenMonitor::ScreenMonitor(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ScreenMonitor::~ScreenMonitor() { clear(); }

void ScreenMonitor::progress(double fraction, const std::string& what) {
  if (quiet_) return;
  if (!terminal_) {
    if (what != last_) std::fprintf(stderr, "%s\n", what.c_str());
    last_ = what;
    return;
  }
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kWidth);
  const double seconds = watch_.seconds();
  const std::string left = fraction > 0.05 && fraction < 1
                               ? formatted(", about %.0f s left", seconds * (1 / fraction - 1))
                               : "";
  std::fprintf(stderr, "\r\033[K[%s%s] %s%s",
               std::string(static_cast<std::size_t>(filled), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), what.c_str(),
               left.c_str());
  last_ = what;
}

void ScreenMonitor::clear() {
  if (!quiet_ && terminal_ && !last_.empty()) std::fprintf(stderr, "\r\033[K");
  last_.clear();
}

void ScreenMonitor::note(const std::string& text) {
  if (quiet_) return;
  clear();
  std::fprintf(stderr, "note: %s\n", text.c_str());
}

std::string step_table_header(const Scene& scene, bool plane_strain, bool wide) {
  const bool regions = shows_regions(scene.pressure.size(), wide);
  const std::size_t n_regions = regions ? scene.pressure.size() : 1;
  const std::size_t n_faults = scene.faults.size();
  const std::size_t n_heated =
      n_temperature_columns(scene.has_temperatures(), scene.pressure.size(), wide);
  const std::size_t n_shown = n_fault_columns(n_regions + n_heated, n_faults, wide);
  std::string line = formatted("%4s  %-18s%7s", "step", "stage", "year");
  std::string units = formatted("%4s  %-18s%7s", "", "", "");
  const auto add = [&](int width, const std::string& heading, const char* unit) {
    line += formatted(" %*.*s", width, width, heading.c_str());
    units += formatted(" %*s", width, unit);
  };
  for (std::size_t r = 0; r < n_regions; ++r)
    add(7, regions ? "dp " + scene.pressure[r].region : "dp min", "bar");
  for (std::size_t r = 0; r < n_heated; ++r)
    add(7, wide ? "dT " + scene.pressure[r].region : "dT", "K");
  if (wide) add(6, "stick", "nodes");
  add(5, "slip", "nodes");
  add(4, "open", "");
  for (std::size_t f = 0; f < n_shown; ++f) add(7, "chi " + scene.faults[f].name, "window");
  if (n_shown < n_faults) add(7, n_shown == 0 ? "chi max" : "others", "window");
  add(8, "chi>0.8", plane_strain ? "m2/m" : "m2");
  add(8, "max slip", "mm");
  if (wide) add(5, "iter", ""), add(8, "time", "ms");
  return line + "\n" + units + "\n";
}

std::string step_table_row(const StepResult& step, bool wide) {
  constexpr double kYear = 31557600.0;
  const bool has_event =
      step.outcome == Outcome::event || step.outcome == Outcome::unresolved_event;
  std::string line = formatted("%4d%c %-18.18s%7.2f", step.step, has_event ? '!' : ' ',
                               step.stage.c_str(), step.time / kYear);
  const bool regions = shows_regions(step.pressure_change.size(), wide);
  std::vector<double> shown = step.pressure_change;
  if (!regions) shown = {*std::ranges::min_element(shown)};
  for (const double dp : shown) line += formatted(" %7s", bar(dp).c_str());
  std::vector<double> heated = step.temperature_change;
  if (!wide && !heated.empty())
    heated = {*std::ranges::max_element(heated, {}, [](double dt) { return std::abs(dt); })};
  for (const double dt : heated) line += formatted(" %7.1f", dt);
  if (!in_equilibrium(step.outcome)) {
    return line + "  " + to_string(step.outcome) + ": " + step.reason + "\n";
  }
  if (wide) line += formatted(" %6d", step.n_stick);
  line += formatted(" %5d %4d", step.n_slip, step.n_open);
  const std::size_t n_shown =
      n_fault_columns(shown.size() + heated.size(), step.faults.size(), wide);
  double area = 0, slip = 0, others = 0;
  char others_mark = ' ';
  for (std::size_t f = 0; f < step.faults.size(); ++f) {
    const FaultMetrics& fault = step.faults[f];
    area += fault.area_chi_080;
    slip = std::max(slip, fault.max_slip);
    if (f < n_shown) {
      line += formatted(" %6.3f%c", fault.chi_bar, mark(fault));
    } else {
      others = std::max(others, fault.chi_bar);
      if (others_mark != '*' && mark(fault) != ' ') others_mark = mark(fault);
    }
  }
  if (n_shown < step.faults.size()) line += formatted(" %6.3f%c", others, others_mark);
  line += formatted(" %8.4g %8.3f", area, slip * 1e3);
  if (wide) line += formatted(" %5d %8.2f", step.counts.newton_iterations, step.seconds * 1e3);
  return line + "\n";
}

std::string case_summary(const CaseResult& result) {
  std::string text = std::string("outcome: ") + to_string(result.outcome);
  if (!result.reason.empty()) text += ", " + result.reason;
  text += "\n" + whole_text(result);
  for (const StageMetrics& stage : result.stages) text += stage_text(result, stage);
  text += events_text(result) + episodes_text(result);
  if (const std::string creep = creep_sentence(result); !creep.empty()) text += creep + "\n";
  text += coupled_text(result);
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace faultsim
