#include "simulator/measures/stage_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace faultsim {
namespace {

double lowest(const std::vector<double>& pressure_change) {
  return pressure_change.empty() ? 0 : *std::ranges::min_element(pressure_change);
}

double chi_bar_of(const StepResult& step) {
  double chi = 0;
  for (const FaultMetrics& fault : step.faults) chi = std::max(chi, fault.chi_bar);
  return chi;
}

}  // namespace

StageSummary::StageSummary(std::string name, int first_step, Eigen::VectorXd reference, bool whole,
                           bool plane_strain)
    : reference_(std::move(reference)), whole_(whole), plane_strain_(plane_strain) {
  metrics_.stage = std::move(name);
  metrics_.first_step = metrics_.last_step = first_step;
}

void StageSummary::add_fault(const FaultMetrics& fault, const Activation& slip,
                             FaultStageMetrics& sum) const {
  sum.slips = sum.slips || slip.max_slip > 0;
  sum.activated = sum.activated || slip.activated;
  sum.opens = sum.opens || fault.open_area > 0;
  sum.chi_bar = std::max(sum.chi_bar, fault.chi_bar);
  sum.chi_max = std::max(sum.chi_max, fault.chi_max);
  sum.area_chi_080 = std::max(sum.area_chi_080, fault.area_chi_080);
  sum.thickness_chi_080 = std::max(sum.thickness_chi_080, fault.thickness_chi_080_max);
  sum.activated_area = std::max(sum.activated_area, slip.area);
  sum.slipping_area = std::max(sum.slipping_area, fault.slipping_area);
  sum.open_area = std::max(sum.open_area, fault.open_area);
  sum.max_slip = std::max(sum.max_slip, slip.max_slip);
  sum.potency = fault.potency;
  sum.moment = whole_ ? fault.moment : sum.moment + fault.moment_step;
}

void StageSummary::count(const SlipEvent& event) {
  const auto add = [&event](auto& sum) {
    ++sum.n_events;
    if (event.moment <= sum.event_moment) return;
    sum.event_moment = event.moment;
    sum.event_magnitude = event.magnitude;
    sum.event_stress_drop = event.stress_drop;
  };
  add(metrics_);
  for (FaultStageMetrics& fault : metrics_.faults) {
    if (fault.fault == event.fault) add(fault);
  }
}

void StageSummary::add(const StepResult& step, const FaultMeter& meter,
                       const FaultNeighbours& neighbours, const NodalState& nodal,
                       const ContactState& state, const PressureChanges& now,
                       const std::vector<std::string>& fault_names,
                       std::span<const SlipEvent> events) {
  StageMetrics& m = metrics_;
  m.last_step = step.step;
  m.faults.resize(fault_names.size());
  surely_.resize(fault_names.size());
  doubtful_.resize(fault_names.size());
  const auto onset_at = [&](int node) {
    const double depth = neighbours.depth(node);
    return FaultOnset{step.step, depth, neighbours.at(node, depth, now)};
  };
  began_.clear();
  double area = 0, slipping = 0, open = 0, activated_area = 0, moment = 0, potency = 0;
  for (std::size_t f = 0; f < step.faults.size(); ++f) {
    const FaultMetrics& fault = step.faults[f];
    const Activation slip = meter.activation(static_cast<int>(f), nodal, state, reference_);
    FaultStageMetrics& own = m.faults[f];
    own.fault = fault_names[f];
    if (slip.activated && !own.activated) {
      own.activation = onset_at(slip.place);
      began_.push_back({static_cast<int>(f), slip.place});
    }
    if (fault.open_area > 0 && !own.opens) {
      own.opening = onset_at(neighbours.widest_gap(static_cast<int>(f), state.jump, state.state));
    }
    add_fault(fault, slip, own);
    surely_[f] |= slip.activated && slip.resolved;
    doubtful_[f] |= !slip.resolved;
    m.chi_bar = std::max(m.chi_bar, fault.chi_bar);
    m.chi_max = std::max(m.chi_max, fault.chi_max);
    m.thickness_chi_080 = std::max(m.thickness_chi_080, fault.thickness_chi_080_max);
    area += fault.area_chi_080;
    slipping += fault.slipping_area;
    open += fault.open_area;
    potency += fault.potency;
    moment += whole_ ? fault.moment : fault.moment_step;
    activated_area += slip.area;
    m.max_slip = std::max(m.max_slip, slip.max_slip);
    m.slips = m.slips || own.slips;
    if (own.opens && !m.opens) {
      m.opens = true;
      m.opening_step = step.step;
      m.opened_fault = own.fault;
    }
    if (own.activated && !m.activated) {
      m.activated = true;
      m.activation_step = step.step;
      m.activated_fault = own.fault;
    }
  }
  m.area_chi_080 = std::max(m.area_chi_080, area);
  m.slipping_area = std::max(m.slipping_area, slipping);
  m.open_area = std::max(m.open_area, open);
  m.activated_area = std::max(m.activated_area, activated_area);
  m.potency = potency;
  m.moment = whole_ ? moment : m.moment + moment;
  for (const SlipEvent& event : events) count(event);
}

StageMetrics StageSummary::finish() {
  bool any_surely = false, any_doubtful = false;
  for (std::size_t f = 0; f < metrics_.faults.size(); ++f) {
    metrics_.faults[f].activation_resolved = surely_[f] || !doubtful_[f];
    any_surely |= surely_[f] != 0;
    any_doubtful |= doubtful_[f] != 0;
  }
  metrics_.activation_resolved = any_surely || !any_doubtful;
  if (!plane_strain_) metrics_.magnitude_if_at_once = moment_magnitude(metrics_.moment);
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
