#include "simulator/loading/metrics.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr double kStrengthFloor = 1e3;  // Pa; keeps χ finite, never enters the law
// χ̄ is off by about this over the number of cells in its window (results/measures).
constexpr double kWindowError = 0.2;

bool has_nodes(const OperatorFault& fault, int j) {
  const auto first = fault.grid_node.begin() + j * fault.n_rows;
  return std::any_of(first, first + fault.n_rows, [](int node) { return node >= 0; });
}

}  // namespace

FaultMeter::FaultMeter(const FaultOperator& op, const ContactLaws& laws, double slip_tolerance,
                       double activation_length)
    : op_(op),
      laws_(laws.begin(), laws.end()),
      slip_tolerance_(slip_tolerance),
      activation_length_(activation_length),
      multiplicity_(op.geometry.half_domain ? 2.0 : 1.0) {
  const FaultGeometry& geometry = op.geometry;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const OperatorFault& fault = geometry.faults[f];
    double area = 0, width = 0;
    for (int j = 0; j < fault.n_columns; ++j) {
      Column column = make_column(fault, static_cast<int>(f), j);
      if (column.nodes.empty()) continue;
      column.strike_edge = (j > 0 && !has_nodes(fault, j - 1)) ||
                           (j + 1 < fault.n_columns && !has_nodes(fault, j + 1));
      width += column.width;
      columns_.push_back(std::move(column));
    }
    for (int k = 0; k < fault.n_nodes; ++k) {
      area += geometry.nodes[static_cast<std::size_t>(fault.first_node + k)].area;
    }
    fault_area_.push_back(area);
    fault_width_.push_back(width);
  }
}

double FaultMeter::down_dip_length(int fault) const {
  double longest = 0;
  for (const Column& c : columns_) {
    if (c.fault == fault) longest = std::max(longest, c.length());
  }
  return longest;
}

double FaultMeter::slip_norm(int node, const Eigen::VectorXd& jump,
                             const Eigen::VectorXd* reference) const {
  const auto& dof = op_.geometry.nodes[static_cast<std::size_t>(node)].dof;
  double sum = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if (dof[c] < 0) continue;
    const double g = jump[dof[c]] - (reference != nullptr ? (*reference)[dof[c]] : 0.0);
    sum += g * g;
  }
  return std::sqrt(sum);
}

void FaultMeter::evaluate(const ContactState& state, NodalState& nodal) const {
  const auto n = static_cast<Eigen::Index>(op_.geometry.nodes.size());
  for (Eigen::VectorXd* v : {&nodal.shear, &nodal.strength, &nodal.critical_index,
                             &nodal.static_critical_index, &nodal.slip}) {
    v->resize(n);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    nodal.slip[k] = slip_norm(static_cast<int>(k), state.jump, nullptr);
    if (state.state[i] == FaultState::open) {  // χ = 1 and counted as open; no load, no strength
      nodal.shear[k] = kStrengthFloor;
      nodal.strength[k] = kStrengthFloor;
      nodal.critical_index[k] = nodal.static_critical_index[k] = 1;
      continue;
    }
    const auto& dof = op_.geometry.nodes[i].dof;
    const double shear = std::hypot(dof[1] >= 0 ? state.traction[dof[1]] : 0.0,
                                    dof[2] >= 0 ? state.traction[dof[2]] : 0.0);
    const double normal = state.traction[dof[0]];
    const FrictionState friction =
        friction_state(op_.geometry.nodes[i], state, static_cast<int>(k));
    const NodeLaw law = friction.cohesive ? laws_[i] : laws_[i].without_cohesion();
    const double static_strength = law.static_limit(normal, true);
    nodal.shear[k] = shear;
    nodal.strength[k] = std::max(law.limit(normal, friction), kStrengthFloor);
    nodal.critical_index[k] = shear / nodal.strength[k];
    nodal.static_critical_index[k] = shear / std::max(static_strength, kStrengthFloor);
  }
  nodal.window.clear();
  for (const Column& column : columns_) {
    nodal.window.push_back(
        window_critical_index(column, nodal.shear, nodal.strength, activation_length_));
  }
}

void FaultMeter::measure_columns(const NodalState& nodal, std::vector<FaultMetrics>& faults) const {
  constexpr double kThreshold = 0.8;
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Column& column = columns_[j];
    FaultMetrics& m = faults[static_cast<std::size_t>(column.fault)];
    m.chi_bar = std::max(m.chi_bar, nodal.window[j].critical_index);
    const double thickness = length_above(column, nodal.critical_index, kThreshold);
    m.thickness_chi_080_max = std::max(m.thickness_chi_080_max, thickness);
    m.thickness_chi_080_mean +=
        thickness * column.width / fault_width_[static_cast<std::size_t>(column.fault)];
    m.area_chi_080 += multiplicity_ * thickness * column.width;
  }
}

std::vector<FaultMetrics> FaultMeter::measure(const NodalState& nodal, const ContactState& state,
                                              const Eigen::VectorXd& before) const {
  const FaultGeometry& geometry = op_.geometry;
  std::vector<FaultMetrics> faults(geometry.faults.size());
  for (std::size_t f = 0; f < faults.size(); ++f) {
    FaultMetrics& m = faults[f];
    const OperatorFault& fault = geometry.faults[f];
    for (int k = fault.first_node; k < fault.first_node + fault.n_nodes; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const OperatorNode& node = geometry.nodes[i];
      m.chi_max = std::max(m.chi_max, nodal.critical_index[k]);
      m.chi_static_max = std::max(m.chi_static_max, nodal.static_critical_index[k]);
      const double area = multiplicity_ * node.area;
      if (state.state[i] == FaultState::slip) m.slipping_area += area;
      if (state.state[i] == FaultState::open) m.open_area += area;
      if (nodal.slip[k] == 0) continue;
      m.max_slip = std::max(m.max_slip, nodal.slip[k]);
      m.potency += area * nodal.slip[k];
      m.moment += area * node.effective_shear_modulus * nodal.slip[k];
      m.moment_step += area * node.effective_shear_modulus * slip_norm(k, state.jump, &before);
    }
    m.mean_slip = fault_area_[f] > 0 ? m.potency / (multiplicity_ * fault_area_[f]) : 0;
  }
  measure_columns(nodal, faults);
  const auto activations = activation(nodal, state, nullptr);
  for (std::size_t f = 0; f < faults.size(); ++f) {
    faults[f].activated_area = activations[f].area;
    faults[f].activated_length = activations[f].length;
    faults[f].activated = activations[f].activated;
    faults[f].activation_resolved = activations[f].resolved;
    faults[f].activated_at_edge = activations[f].at_edge;
  }
  return faults;
}

SlipExtent FaultMeter::extent_of(const Column& column, const ContactState& state,
                                 const Eigen::VectorXd* reference) const {
  std::vector<double> slip;
  for (const int node : column.nodes) slip.push_back(slip_norm(node, state.jump, reference));
  return slip_extent(column, slip, slip_tolerance_, activation_length_);
}

/// Whether slip may reach the activation length on a finer mesh although it does not on this one.
/// Where it did before, the mesh has shown that it can tell. Where it is open over that length, it
/// carries no shear to slide under.
bool FaultMeter::near_activation(const Column& column, const WindowIndex& window,
                                 const ContactState& state) const {
  double open = 0;
  for (std::size_t i = 0; i < column.nodes.size(); ++i) {
    if (state.state[column.nodes[i]] == FaultState::open) open += column.share(i);
  }
  return column.length() >= activation_length_ && open < activation_length_ &&
         window.critical_index + kWindowError / window.n_cells >= 1 &&
         !extent_of(column, state, nullptr).surely;
}

std::vector<FaultMeter::Activation> FaultMeter::activation(const NodalState& nodal,
                                                           const ContactState& state,
                                                           const Eigen::VectorXd* reference) const {
  std::vector<Activation> result(op_.geometry.faults.size());
  std::vector<char> surely(result.size(), 0);
  std::vector<double> place_slip(result.size(), 0);
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const Column& column = columns_[j];
    Activation& a = result[column.fault];
    double largest = 0;
    int place = -1;
    for (const int node : column.nodes) {
      const double slip = slip_norm(node, state.jump, reference);
      if (slip > largest) place = node;
      largest = std::max(largest, slip);
    }
    a.max_slip = std::max(a.max_slip, largest);
    const SlipExtent extent = extent_of(column, state, reference);
    surely[column.fault] |= extent.surely;
    a.resolved = a.resolved && extent.resolved &&
                 (extent.reaches || !near_activation(column, nodal.window[j], state));
    a.length = std::max(a.length, extent.longest);
    if (!extent.reaches) continue;
    const auto slips = [&](int node) {
      return slip_norm(node, state.jump, reference) > slip_tolerance_;
    };
    a.activated = true;
    if (largest > place_slip[column.fault]) {
      place_slip[column.fault] = largest;
      a.place = place;
    }
    a.at_edge = a.at_edge || column.strike_edge ||
                (slips(column.nodes.front()) && !std::isnan(column.tip_before)) ||
                (slips(column.nodes.back()) && !std::isnan(column.tip_after));
    a.area += multiplicity_ * extent.total * column.width;
  }
  // One column that is surely activated is enough.
  for (std::size_t f = 0; f < result.size(); ++f) result[f].resolved |= surely[f] != 0;
  return result;
}

}  // namespace faultsim
