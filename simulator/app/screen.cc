#include "simulator/app/screen.h"

#include <unistd.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <span>

namespace faultsim {
namespace {

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

std::string bar(double pascal) { return format("%.0f", pascal / 1e5); }

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
                               ? format(", about %.0f s left", seconds * (1 / fraction - 1))
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

std::string step_table_header(const CaseResult& names) {
  std::string line = format("%4s  %-22s %7s", "step", "stage", "year");
  for (const std::string& region : names.region_names)
    line += format(" %9.9s", ("dp " + region).c_str());
  line += format("  %6s %6s %6s", "stick", "slip", "open");
  for (const std::string& fault : names.fault_names)
    line += format(" %8.8s", ("chi " + fault).c_str());
  line += format(" %11s %10s %5s %8s\n", "chi>0.8", "max slip", "iter", "time");
  line += format("%4s  %-22s %7s", "", "", "");
  for (std::size_t i = 0; i < names.region_names.size(); ++i) line += format(" %9s", "bar");
  line += format("  %6s %6s %6s", "nodes", "nodes", "nodes");
  for (std::size_t i = 0; i < names.fault_names.size(); ++i) line += format(" %8s", "window");
  return line + format(" %11s %10s %5s %8s\n", names.plane_strain ? "m2/m" : "m2", "mm", "", "ms");
}

std::string step_table_row(const StepResult& step) {
  constexpr double kYear = 31557600.0;
  const bool has_event =
      step.outcome == Outcome::event || step.outcome == Outcome::unresolved_event;
  std::string line = format("%4d%c %-22.22s %7.2f", step.step, has_event ? '!' : ' ',
                            step.stage.c_str(), step.time / kYear);
  for (const double dp : step.pressure_change) line += format(" %9s", bar(dp).c_str());
  if (!in_equilibrium(step.outcome)) {
    return line + "  " + to_string(step.outcome) + ": " + step.reason + "\n";
  }
  line += format("  %6d %6d %6d", step.n_stick, step.n_slip, step.n_open);
  double area = 0, slip = 0;
  for (const FaultMetrics& fault : step.faults) {
    line += format(" %7.3f%s", fault.chi_bar, fault.activated ? "*" : " ");
    area += fault.area_chi_080;
    slip = std::max(slip, fault.max_slip);
  }
  return line + format(" %11.4g %10.3f %5d %8.2f\n", area, slip * 1e3,
                       step.counts.newton_iterations, step.seconds * 1e3);
}

namespace {

std::string size_text(double moment, const std::optional<double>& magnitude) {
  return magnitude ? format("Mw %.1f", *magnitude) : format("M0 %.3g N m/m", moment);
}

std::string events_text(const CaseResult& result) {
  if (result.events.empty()) return "";
  std::string text = format("slip events: %zu (! in the table)\n", result.events.size());
  constexpr std::size_t kShown = 20;
  for (const SlipEvent& e :
       std::span(result.events).first(std::min(result.events.size(), kShown))) {
    text += format("  step %d at %s bar: fault %s at %.0f m depth, nucleus %.3g m, slip %.1f mm, ",
                   e.step, bar(e.pressure_change).c_str(), e.fault.c_str(), e.depth,
                   e.nucleation_length, e.max_slip * 1e3);
    text += size_text(e.moment, e.magnitude);
    if (!e.resolved) text += ", NOT RESOLVED: its size is the mesh's";
    if (!e.evidence_holds) text += ", EVIDENCE DOES NOT HOLD";
    text += "\n";
  }
  if (result.events.size() > kShown) text += "  the rest is in result.json\n";
  return text;
}

std::string episodes_text(const CaseResult& result) {
  std::string text;
  for (const Episode& e : result.episodes) {
    text += format("episode: fault %s, steps %d-%d of %s, from %s bar%s, slip %.1f mm, ",
                   e.fault.c_str(), e.first_step, e.last_step, e.stage.c_str(),
                   bar(e.pressure_change).c_str(), e.after_recovery ? " as pressure recovered" : "",
                   e.max_slip * 1e3);
    text += size_text(e.moment, e.magnitude) + "\n";
  }
  if (result.unexpected) text += "UNEXPECTED REACTIVATION: activated again as pressure recovers\n";
  return text;
}

/// How creep was stepped and the most that it changed on each fault.
std::string creep_text(const CaseResult& result) {
  int n_steps = 0;
  double error = 0;
  std::vector<double> shear(result.fault_names.size()), normal(shear);
  for (const StepResult& step : result.steps) {
    if (!step.creep) continue;
    n_steps += step.creep->time_steps;
    error = std::max(error, step.creep->time_error);
    for (std::size_t f = 0; f < step.creep->faults.size(); ++f) {
      const FaultCreep& fault = step.creep->faults[f];
      shear[f] = std::max(shear[f], fault.shear_max);
      normal[f] = std::max({normal[f], fault.normal_max, -fault.normal_min});
    }
  }
  if (n_steps == 0) return "";
  std::string text = format("creep: %d time steps", n_steps);
  if (error > 0) text += format(", halving them changes tractions by up to %.3g MPa", error / 1e6);
  text += "; salt changed shear and normal traction by up to";
  for (std::size_t f = 0; f < shear.size(); ++f) {
    text += format("%s %.1f and %.1f MPa on %s", f == 0 ? "" : ",", shear[f] / 1e6, normal[f] / 1e6,
                   result.fault_names[f].c_str());
  }
  return text + "\n";
}

}  // namespace

std::string case_summary(const CaseResult& result) {
  std::string text = std::string("outcome: ") + to_string(result.outcome);
  if (!result.reason.empty()) text += ", " + result.reason;
  text += "\n";
  const StageMetrics& whole = result.whole;
  if (whole.activated) {
    text += format(
        "activated: fault %s in load step %d at a pressure change of %s bar (* in the table)\n",
        whole.activated_fault.c_str(), *whole.activation_step,
        bar(*whole.activation_pressure).c_str());
  } else {
    text += "activated: no fault";
    if (result.pressure_margin > 0)
      text += format(", about %s bar more depletion to a window index of 1",
                     bar(result.pressure_margin).c_str());
    text += "\n";
  }
  const char* area_unit = result.plane_strain ? "m2/m" : "m2";
  const char* moment_unit = result.plane_strain ? "N m/m" : "N m";
  for (const StageMetrics& stage : result.stages) {
    text += format(
        "  %-22.22s steps %d-%d: window chi %.3f, slip within the stage %.2f mm, activated area "
        "%.4g %s, M0 %.3g %s",
        stage.stage.c_str(), stage.first_step, stage.last_step, stage.chi_bar, stage.max_slip * 1e3,
        stage.activated_area, area_unit, stage.moment, moment_unit);
    if (stage.magnitude) text += format(" (Mw %.1f)", *stage.magnitude);
    text += stage.activated ? format(", activated in step %d\n", *stage.activation_step) : "\n";
  }
  text += events_text(result) + episodes_text(result) + creep_text(result);
  for (const std::string& warning : result.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace faultsim
