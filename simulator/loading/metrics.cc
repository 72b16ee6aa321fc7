#include "simulator/loading/metrics.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr double kStrengthFloor = 1e3;  // Pa; keeps χ finite, never enters the law
// χ̄ is off by about this over the number of cells in its window (results/measures).
constexpr double kWindowError = 0.2;

}  // namespace

FaultMeter::FaultMeter(const FaultOperator& op, const ContactLaws& laws, double slip_tolerance,
                       double activation_length)
    : op_(op),
      laws_(laws),
      slip_tolerance_(slip_tolerance),
      activation_length_(activation_length),
      multiplicity_(op.geometry.half_domain ? 2.0 : 1.0) {
  const FaultGeometry& geometry = op.geometry;
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const OperatorFault& fault = geometry.faults[f];
    double area = 0, width = 0;
    for (const Profile& profile : fault.profiles) {
      width += profile.width;
      lines_.push_back({static_cast<int>(f), profile, WindowSearch(profile, activation_length)});
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
  for (const Profile& profile : op_.geometry.faults[fault].profiles)
    longest = std::max(longest, profile.length());
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
  NodeLaw bare;  // of a node that lost its cohesion
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
    if (!friction.cohesive) bare = laws_[i].without_cohesion();
    const NodeLaw& law = friction.cohesive ? laws_[i] : bare;
    const double static_strength = law.static_limit(normal, true);
    nodal.shear[k] = shear;
    nodal.strength[k] = std::max(law.limit(normal, friction), kStrengthFloor);
    nodal.critical_index[k] = shear / nodal.strength[k];
    nodal.static_critical_index[k] = shear / std::max(static_strength, kStrengthFloor);
  }
  nodal.window.clear();
  for (const Line& line : lines_)
    nodal.window.push_back(line.windows.most_loaded(nodal.shear, nodal.strength));
}

void FaultMeter::measure_profiles(const NodalState& nodal,
                                  std::vector<FaultMetrics>& faults) const {
  constexpr double kThreshold = 0.8;
  for (std::size_t j = 0; j < lines_.size(); ++j) {
    const Line& line = lines_[j];
    const double width = line.profile.width;
    FaultMetrics& m = faults[static_cast<std::size_t>(line.fault)];
    m.chi_bar = std::max(m.chi_bar, nodal.window[j].critical_index);
    const double thickness = length_above(line.profile, nodal.critical_index, kThreshold);
    m.thickness_chi_080_max = std::max(m.thickness_chi_080_max, thickness);
    m.thickness_chi_080_mean +=
        thickness * width / fault_width_[static_cast<std::size_t>(line.fault)];
    m.area_chi_080 += multiplicity_ * thickness * width;
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
  measure_profiles(nodal, faults);
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

/// Whether slip may reach the activation length on a finer mesh although it does not on this one.
/// Where it did before, the mesh has shown that it can tell. Where it is open over that length, it
/// carries no shear to slide under.
bool FaultMeter::near_activation(const Profile& profile, const WindowIndex& window,
                                 const NodalState& nodal, const ContactState& state) const {
  double open = 0;
  for (std::size_t i = 0; i < profile.samples.size(); ++i) {
    if (state.state[profile.samples[i].node[0]] == FaultState::open) open += profile.share(i);
  }
  return profile.length() >= activation_length_ && open < activation_length_ &&
         window.critical_index + kWindowError / window.n_cells >= 1 &&
         !slip_extent(profile, nodal.slip, slip_tolerance_, activation_length_).surely;
}

std::vector<FaultMeter::Activation> FaultMeter::activation(const NodalState& nodal,
                                                           const ContactState& state,
                                                           const Eigen::VectorXd* reference) const {
  std::vector<Activation> result(op_.geometry.faults.size());
  std::vector<char> surely(result.size(), 0);
  std::vector<double> place_slip(result.size(), 0);
  Eigen::VectorXd since;
  if (reference != nullptr) {
    since.resize(nodal.slip.size());
    for (Eigen::Index k = 0; k < since.size(); ++k)
      since[k] = slip_norm(static_cast<int>(k), state.jump, reference);
  }
  const Eigen::VectorXd& slip = reference != nullptr ? since : nodal.slip;
  for (std::size_t f = 0; f < result.size(); ++f) {
    const OperatorFault& fault = op_.geometry.faults[f];
    if (fault.n_nodes > 0)
      result[f].max_slip = slip.segment(fault.first_node, fault.n_nodes).maxCoeff();
  }
  for (std::size_t j = 0; j < lines_.size(); ++j) {
    const auto& [fault, profile, windows] = lines_[j];
    Activation& a = result[fault];
    double largest = 0;
    int place = -1;
    for (const ProfileSample& sample : profile.samples) {
      if (slip[sample.node[0]] > largest) place = sample.node[0];
      largest = std::max(largest, slip[sample.node[0]]);
    }
    const SlipExtent extent = slip_extent(profile, slip, slip_tolerance_, activation_length_);
    surely[fault] |= extent.surely;
    a.resolved = a.resolved && extent.resolved &&
                 (extent.reaches || !near_activation(profile, nodal.window[j], nodal, state));
    a.length = std::max(a.length, extent.longest);
    if (!extent.reaches) continue;
    a.activated = true;
    if (largest > place_slip[fault]) {
      place_slip[fault] = largest;
      a.place = place;
    }
    const auto slips = [&](const ProfileSample& at) { return at.slip(slip) > slip_tolerance_; };
    a.at_edge = a.at_edge || profile.strike_edge ||
                (slips(profile.samples.front()) && !std::isnan(profile.tip_before)) ||
                (slips(profile.samples.back()) && !std::isnan(profile.tip_after));
    a.area += multiplicity_ * extent.total * profile.width;
  }
  // One profile that is surely activated is enough.
  for (std::size_t f = 0; f < result.size(); ++f) result[f].resolved |= surely[f] != 0;
  return result;
}

}  // namespace faultsim
