#include "simulator/measures/metrics.h"

#include <algorithm>
#include <cmath>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr double kStrengthFloor = 1e3;  // Pa; keeps χ finite, never enters the law
// χ̄ is off by about this over the number of cells in its window (results/measures).
constexpr double kWindowError = 0.2;

/// √(a² + b²); either is 0 in plane strain and on planes of symmetry.
double length_of(double a, double b) {
  if (a == 0) return std::abs(b);
  return b == 0 ? std::abs(a) : std::hypot(a, b);
}

/// |g_T − reference| of a node, m. @param reference  empty = zero.
double slip_norm(const std::array<int, 3>& dof, const Eigen::VectorXd& jump,
                 const Eigen::VectorXd& reference) {
  double sum = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if (dof[c] < 0) continue;
    const double g = jump[dof[c]] - (reference.size() > 0 ? reference[dof[c]] : 0.0);
    sum += g * g;
  }
  return sum == 0 ? 0 : std::sqrt(sum);
}

}  // namespace

FaultMeter::FaultMeter(const FaultOperator& op, const ContactLaws& laws, double slip_tolerance,
                       double activation_length)
    : op_(op),
      laws_(laws),
      slip_tolerance_(slip_tolerance),
      activation_length_(activation_length),
      multiplicity_(op.geometry.half_domain ? 2.0 : 1.0) {
  const FaultGeometry& geometry = op.geometry;
  for (const OperatorNode& node : geometry.nodes) {
    const double area = multiplicity_ * node.area;
    nodes_.push_back({node.dof, area, area * node.effective_shear_modulus});
  }
  for (std::size_t f = 0; f < geometry.faults.size(); ++f) {
    const OperatorFault& fault = geometry.faults[f];
    double area = 0, width = 0;
    first_line_.push_back(lines_.size());
    for (const Profile& profile : fault.profiles) {
      width += profile.width;
      lines_.push_back({static_cast<int>(f), profile, profile.length(),
                        WindowSearch(profile, activation_length)});
    }
    for (int k = 0; k < fault.n_nodes; ++k) {
      area += geometry.nodes[fault.first_node + k].area;
    }
    fault_area_.push_back(area);
    fault_width_.push_back(width);
  }
  first_line_.push_back(lines_.size());
}

double FaultMeter::down_dip_length(int fault) const {
  double longest = 0;
  for (const Profile& profile : op_.geometry.faults[fault].profiles)
    longest = std::max(longest, profile.length());
  return longest;
}

void FaultMeter::evaluate_node(std::size_t k, const ContactState& state, NodalState& nodal) const {
  const auto& dof = nodes_[k].dof;
  const double shear = length_of(dof[1] >= 0 ? state.traction[dof[1]] : 0.0,
                                 dof[2] >= 0 ? state.traction[dof[2]] : 0.0);
  const double normal = state.traction[dof[0]];
  const NodeLaw& law = laws_[k];
  nodal.shear[k] = shear;
  if (!law.weakens() && state.cohesion_lost[k] == 0) {  // strength is the static one
    nodal.strength[k] = std::max(law.static_limit(normal, true), kStrengthFloor);
    nodal.critical_index[k] = nodal.static_critical_index[k] = shear / nodal.strength[k];
    return;
  }
  const FrictionState friction = friction_state(op_.geometry.nodes[k], state, static_cast<int>(k));
  NodeLaw bare;  // of a node that lost its cohesion
  if (!friction.cohesive) bare = law.without_cohesion();
  const NodeLaw& actual = friction.cohesive ? law : bare;
  nodal.strength[k] = std::max(actual.limit(normal, friction), kStrengthFloor);
  nodal.critical_index[k] = shear / nodal.strength[k];
  nodal.static_critical_index[k] =
      shear / std::max(actual.static_limit(normal, true), kStrengthFloor);
}

void FaultMeter::evaluate(const ContactState& state, NodalState& nodal) const {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  for (Eigen::VectorXd* v : {&nodal.shear, &nodal.strength, &nodal.critical_index,
                             &nodal.static_critical_index, &nodal.slip}) {
    v->resize(n);
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    nodal.slip[k] = slip_norm(nodes_[k].dof, state.jump, {});
    if (state.state[k] == FaultState::open) {  // χ = 1 and counted as open; no load, no strength
      nodal.shear[k] = kStrengthFloor;
      nodal.strength[k] = kStrengthFloor;
      nodal.critical_index[k] = nodal.static_critical_index[k] = 1;
    } else {
      evaluate_node(k, state, nodal);
    }
  }
  nodal.window.clear();
  nodal.near_activation.clear();
  nodal.since_start.clear();
  for (const Line& line : lines_) {
    nodal.window.push_back(line.windows.most_loaded(nodal.shear, nodal.strength));
    nodal.near_activation.push_back(near_activation(line, nodal.window.back(), nodal, state));
  }
  for (std::size_t f = 0; f < op_.geometry.faults.size(); ++f)
    nodal.since_start.push_back(activation_by(static_cast<int>(f), nodal, nodal.slip));
}

void FaultMeter::measure_profiles(const NodalState& nodal,
                                  std::vector<FaultMetrics>& faults) const {
  constexpr double kThreshold = 0.8;
  for (std::size_t j = 0; j < lines_.size(); ++j) {
    const Line& line = lines_[j];
    const double width = line.profile.width;
    FaultMetrics& m = faults[line.fault];
    m.chi_bar = std::max(m.chi_bar, nodal.window[j].critical_index);
    const double thickness = length_above(line.profile, nodal.critical_index, kThreshold);
    m.thickness_chi_080_max = std::max(m.thickness_chi_080_max, thickness);
    m.thickness_chi_080_mean += thickness * width / fault_width_[line.fault];
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
      const Node& node = nodes_[k];
      m.chi_max = std::max(m.chi_max, nodal.critical_index[k]);
      m.chi_static_max = std::max(m.chi_static_max, nodal.static_critical_index[k]);
      if (state.state[k] == FaultState::slip) m.slipping_area += node.area;
      if (state.state[k] == FaultState::open) m.open_area += node.area;
      if (nodal.slip[k] == 0) continue;
      m.max_slip = std::max(m.max_slip, nodal.slip[k]);
      m.potency += node.area * nodal.slip[k];
      m.moment += node.moment_per_slip * nodal.slip[k];
      m.moment_step += node.moment_per_slip * slip_norm(node.dof, state.jump, before);
    }
    m.mean_slip = fault_area_[f] > 0 ? m.potency / (multiplicity_ * fault_area_[f]) : 0;
  }
  measure_profiles(nodal, faults);
  for (std::size_t f = 0; f < faults.size(); ++f) {
    const Activation& activation = nodal.since_start[f];
    faults[f].activated_area = activation.area;
    faults[f].activated_length = activation.length;
    faults[f].activated = activation.activated;
    faults[f].activation_resolved = activation.resolved;
    faults[f].activated_at_edge = activation.at_edge;
  }
  return faults;
}

/// Whether slip may reach the activation length on a finer mesh although it does not on this one.
/// Where it did before, the mesh has shown that it can tell. Where it is open over that length, it
/// carries no shear to slide under.
bool FaultMeter::near_activation(const Line& line, const WindowIndex& window,
                                 const NodalState& nodal, const ContactState& state) const {
  const bool may_slide = window.critical_index + kWindowError / window.n_cells >= 1;
  if (line.length < activation_length_ || !may_slide) return false;
  const Profile& profile = line.profile;
  double open = 0;
  for (std::size_t i = 0; i < profile.samples.size(); ++i) {
    if (state.state[profile.samples[i].node[0]] == FaultState::open) open += profile.share(i);
  }
  return open < activation_length_ &&
         !slip_extent(profile, nodal.slip, slip_tolerance_, activation_length_).surely;
}

Activation FaultMeter::activation(int fault, const NodalState& nodal, const ContactState& state,
                                  const Eigen::VectorXd& reference) const {
  if (reference.size() == 0) return nodal.since_start[fault];
  Eigen::VectorXd slip(nodal.slip.size());  // of the nodes of this fault
  const OperatorFault& grid = op_.geometry.faults[fault];
  for (int k = grid.first_node; k < grid.first_node + grid.n_nodes; ++k)
    slip[k] = slip_norm(nodes_[k].dof, state.jump, reference);
  return activation_by(fault, nodal, slip);
}

/// @param slip  per node, m.
Activation FaultMeter::activation_by(int fault, const NodalState& nodal,
                                     const Eigen::VectorXd& slip) const {
  Activation a;
  const OperatorFault& grid = op_.geometry.faults[fault];
  if (grid.n_nodes > 0) a.max_slip = slip.segment(grid.first_node, grid.n_nodes).maxCoeff();
  double place_slip = 0;
  bool surely = false;
  for (std::size_t j = first_line_[fault]; j < first_line_[fault + 1]; ++j) {
    const Profile& profile = lines_[j].profile;
    const SlipExtent extent = a.max_slip == 0
                                  ? SlipExtent()
                                  : slip_extent(profile, slip, slip_tolerance_, activation_length_);
    surely = surely || extent.surely;
    a.resolved = a.resolved && extent.resolved && (extent.reaches || nodal.near_activation[j] == 0);
    a.length = std::max(a.length, extent.longest);
    if (!extent.reaches) continue;
    a.activated = true;
    double largest = 0;
    int place = -1;
    for (const ProfileSample& sample : profile.samples) {
      if (slip[sample.node[0]] > largest) place = sample.node[0];
      largest = std::max(largest, slip[sample.node[0]]);
    }
    if (largest > place_slip) {
      place_slip = largest;
      a.place = place;
    }
    const auto slips = [&](const ProfileSample& at) { return at.slip(slip) > slip_tolerance_; };
    a.at_edge = a.at_edge || profile.strike_edge ||
                (slips(profile.samples.front()) && !std::isnan(profile.tip_before)) ||
                (slips(profile.samples.back()) && !std::isnan(profile.tip_after));
    a.area += multiplicity_ * extent.total * profile.width;
  }
  a.resolved = a.resolved || surely;  // one profile that is surely activated is enough
  return a;
}

}  // namespace faultsim
