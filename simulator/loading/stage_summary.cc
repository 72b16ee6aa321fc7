#include "simulator/loading/stage_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faultsim {
namespace {

double lowest(const std::vector<double>& pressure_change) {
  return pressure_change.empty()
             ? 0
             : *std::min_element(pressure_change.begin(), pressure_change.end());
}

double chi_bar_of(const StepResult& step) {
  double chi = 0;
  for (const FaultMetrics& fault : step.faults) chi = std::max(chi, fault.chi_bar);
  return chi;
}

}  // namespace

StageSummary::StageSummary(std::string name, int first_step, const Eigen::VectorXd* reference,
                           bool whole, bool plane_strain)
    : whole_(whole), plane_strain_(plane_strain) {
  metrics_.stage = std::move(name);
  metrics_.first_step = metrics_.last_step = first_step;
  if (reference != nullptr) reference_ = *reference;
}

void StageSummary::add(const StepResult& step, const FaultMeter& meter, const ContactState& state,
                       const std::vector<std::string>& fault_names,
                       std::span<const SlipEvent> events) {
  StageMetrics& m = metrics_;
  m.last_step = step.step;
  const auto activations = meter.activation(state, reference_ ? &*reference_ : nullptr);
  double area = 0, slipping = 0, open = 0, activated_area = 0, moment = 0, potency = 0;
  for (std::size_t f = 0; f < step.faults.size(); ++f) {
    const FaultMetrics& fault = step.faults[f];
    m.chi_bar = std::max(m.chi_bar, fault.chi_bar);
    m.chi_max = std::max(m.chi_max, fault.chi_max);
    m.thickness_chi_080 = std::max(m.thickness_chi_080, fault.thickness_chi_080_max);
    area += fault.area_chi_080;
    slipping += fault.slipping_area;
    open += fault.open_area;
    potency += fault.potency;
    moment += whole_ ? fault.moment : fault.moment_step;
    activated_area += activations[f].area;
    m.max_slip = std::max(m.max_slip, activations[f].max_slip);
    if (!activations[f].activated || m.activated) continue;
    m.activated = true;
    m.activation_step = step.step;
    m.activation_pressure = lowest(step.pressure_change);
    m.activated_fault = fault_names[f];
  }
  m.area_chi_080 = std::max(m.area_chi_080, area);
  m.slipping_area = std::max(m.slipping_area, slipping);
  m.open_area = std::max(m.open_area, open);
  m.activated_area = std::max(m.activated_area, activated_area);
  m.potency = potency;
  m.moment = whole_ ? moment : m.moment + moment;
  for (const SlipEvent& event : events) {
    ++m.n_events;
    if (event.moment <= m.event_moment) continue;
    m.event_moment = event.moment;
    m.event_magnitude = event.magnitude;
  }
}

StageMetrics StageSummary::finish() {
  if (!plane_strain_) metrics_.magnitude = moment_magnitude(metrics_.moment);
  return metrics_;
}

double pressure_margin(std::span<const StepResult> steps) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (steps.size() < 2) return kNone;
  const double start = chi_bar_of(steps.front());
  double peak = start, depletion = 0;
  for (const StepResult& step : steps) {
    const double chi = chi_bar_of(step);
    if (chi > peak) {
      peak = chi;
      depletion = -lowest(step.pressure_change);
    }
  }
  if (peak <= start || depletion <= 0 || peak >= 1) return kNone;
  return depletion * ((1 - start) / (peak - start) - 1);
}

}  // namespace faultsim
