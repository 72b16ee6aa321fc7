#include "simulator/loading/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr double kStrengthFloor = 1e3;  // Pa; keeps χ finite, never enters D3 (design section 2)
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Column make_column(const OperatorFault& fault, int fault_index, int j) {
  Column column{
      fault_index, fault.column_width[static_cast<std::size_t>(j)], {}, {}, {}, kNaN, kNaN, false};
  double s = 0;
  const Eigen::Vector3d* last = nullptr;
  for (int row = 0; row < fault.n_rows; ++row) {
    const auto point = static_cast<std::size_t>(j * fault.n_rows + row);
    if (fault.grid_used[point] == 0) continue;
    if (last != nullptr) s += (fault.grid_position[point] - *last).norm();
    last = &fault.grid_position[point];
    if (fault.grid_node[point] >= 0) {
      column.nodes.push_back(fault.grid_node[point]);
      column.position.push_back(s);
    } else if (column.nodes.empty()) {
      column.tip_before = s;
    } else if (std::isnan(column.tip_after)) {
      column.tip_after = s;
    }
  }
  const std::size_t n = column.nodes.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double before = i > 0 ? column.position[i - 1] : column.tip_before;
    const double after = i + 1 < n ? column.position[i + 1] : column.tip_after;
    column.share.push_back((std::isnan(before) ? 0 : (column.position[i] - before) / 2) +
                           (std::isnan(after) ? 0 : (after - column.position[i]) / 2));
  }
  return column;
}

bool has_nodes(const OperatorFault& fault, int j) {
  const auto first = fault.grid_node.begin() + j * fault.n_rows;
  return std::any_of(first, first + fault.n_rows, [](int node) { return node >= 0; });
}

double start_of(const Column& c) {
  return std::isnan(c.tip_before) ? c.position.front() : (c.tip_before + c.position.front()) / 2;
}
double end_of(const Column& c) {
  return std::isnan(c.tip_after) ? c.position.back() : (c.tip_after + c.position.back()) / 2;
}

/// Length of [0, width] where the line from a to b lies above the threshold.
double part_above(double a, double b, double width, double threshold) {
  if (a > threshold && b > threshold) return width;
  if (a <= threshold && b <= threshold) return 0;
  return width * (std::max(a, b) - threshold) / std::abs(a - b);
}

/// Running integrals of a nodal profile over a column's profile: linear between nodes, constant
/// over the end half cells.
class Integral {
 public:
  Integral(const Column& column, const Eigen::VectorXd& profile, double floor)
      : column_(column), profile_(profile), floor_(floor) {
    const std::size_t n = column.nodes.size();
    sum_.resize(n);
    sum_[0] = value(0) * (column.position[0] - start_of(column));
    for (std::size_t i = 1; i < n; ++i) {
      sum_[i] = sum_[i - 1] +
                0.5 * (value(i - 1) + value(i)) * (column.position[i] - column.position[i - 1]);
    }
  }
  /// Integral from the start to s, s in segment i (between nodes i−1 and i; i = 0: before the
  /// first).
  double to(double s, std::size_t i) const {
    const auto& x = column_.position;
    if (i == 0) return value(0) * (s - start_of(column_));
    if (i == x.size()) return sum_.back() + value(i - 1) * (s - x.back());
    const double share = (s - x[i - 1]) / (x[i] - x[i - 1]);
    const double here = value(i - 1) + share * (value(i) - value(i - 1));
    return sum_[i - 1] + 0.5 * (value(i - 1) + here) * (s - x[i - 1]);
  }

 private:
  double value(std::size_t i) const { return std::max(profile_[column_.nodes[i]], floor_); }
  const Column& column_;
  const Eigen::VectorXd& profile_;
  double floor_;
  std::vector<double> sum_;
};

/// Longest stretch and total length of slip above the tolerance, linear to 0 at unsplit ends.
struct Extent {
  double longest = 0, total = 0;
};
class ExtentFinder {
 public:
  void add(double a, double b, double width, double tolerance) {
    const double above = part_above(a, b, width, tolerance);
    const bool enters = a <= tolerance;
    if (enters) run_ = 0;
    run_ += above;
    extent_.total += above;
    extent_.longest = std::max(extent_.longest, run_);
    if (b <= tolerance) run_ = 0;
  }
  Extent extent() const { return extent_; }

 private:
  Extent extent_;
  double run_ = 0;
};

}  // namespace

double length_above(const Column& column, const Eigen::VectorXd& profile, double threshold) {
  const auto& x = column.position;
  const std::size_t n = x.size();
  if (n == 0) return 0;
  double length = 0;
  if (profile[column.nodes.front()] > threshold) length += x.front() - start_of(column);
  if (profile[column.nodes.back()] > threshold) length += end_of(column) - x.back();
  for (std::size_t i = 1; i < n; ++i) {
    length += part_above(profile[column.nodes[i - 1]], profile[column.nodes[i]], x[i] - x[i - 1],
                         threshold);
  }
  return length;
}

double window_critical_index(const Column& column, const NodalState& nodal, double length) {
  const std::size_t n = column.nodes.size();
  if (n == 0) return 0;
  const Integral load(column, nodal.shear, 0.0), strength(column, nodal.strength, kStrengthFloor);
  const double begin = start_of(column), end = end_of(column);
  const double window = std::min(length, end - begin);
  // The ratio is largest with one window edge at a node (or at the column's end) up to O(h²).
  double best = 0;
  std::size_t ia = 0, ib = 0;  // segments of the two window edges, moving down dip together
  const auto& x = column.position;
  const auto try_at = [&](double a) {
    const double b = a + window;
    while (ia < n && x[ia] < a) ++ia;
    while (ib < n && x[ib] < b) ++ib;
    const double over = strength.to(b, ib) - strength.to(a, ia);
    if (over > 0) best = std::max(best, (load.to(b, ib) - load.to(a, ia)) / over);
  };
  std::size_t i = 0, k = 0;  // next node at the upper and at the lower window edge
  double a = begin;
  while (true) {
    try_at(a);
    while (i < n && x[i] <= a) ++i;
    while (k < n && x[k] - window <= a) ++k;
    const double last = end - window;
    const double next = std::min(i < n ? x[i] : last, k < n ? x[k] - window : last);
    if (a >= last) break;
    a = std::min(std::max(next, a), last);
    if (i >= n && k >= n) a = last;
  }
  return best;
}

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
  for (const CoulombLaw& law : laws.node) {
    static_tangent_.push_back(std::tan(law.static_friction_angle));
    weakens_.push_back(law.dynamic_friction_angle < law.static_friction_angle ? 1 : 0);
  }
}

double FaultMeter::down_dip_length(int fault) const {
  double longest = 0;
  for (const Column& c : columns_) {
    if (c.fault != fault) continue;
    const double first = std::isnan(c.tip_before) ? c.position.front() : c.tip_before;
    const double last = std::isnan(c.tip_after) ? c.position.back() : c.tip_after;
    longest = std::max(longest, last - first);
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
    const double normal = std::min(state.traction[dof[0]], 0.0);
    const CoulombLaw& law = laws_.node[i];
    const double cohesion = state.cohesion_lost[i] != 0 ? 0.0 : law.cohesion;
    const double static_strength = cohesion - normal * static_tangent_[i];
    double strength = static_strength;
    if (weakens_[i] != 0) {
      const double slip = laws_.cumulated[i] != 0 ? state.slip_path[k] : nodal.slip[k];
      CoulombLaw current = law;
      current.cohesion = cohesion;
      strength = limit_shear_traction(current, normal, slip).value;
    }
    nodal.shear[k] = shear;
    nodal.strength[k] = strength;
    nodal.critical_index[k] = shear / std::max(strength, kStrengthFloor);
    nodal.static_critical_index[k] = shear / std::max(static_strength, kStrengthFloor);
  }
}

void FaultMeter::measure_columns(const NodalState& nodal, std::vector<FaultMetrics>& faults) const {
  constexpr double kThreshold = 0.8;
  for (const Column& column : columns_) {
    FaultMetrics& m = faults[static_cast<std::size_t>(column.fault)];
    m.chi_bar = std::max(m.chi_bar, window_critical_index(column, nodal, activation_length_));
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
  const auto activations = activation(state, nullptr);
  for (std::size_t f = 0; f < faults.size(); ++f) {
    faults[f].activated_area = activations[f].area;
    faults[f].activated_length = activations[f].length;
    faults[f].activated = activations[f].activated;
    faults[f].activated_at_edge = activations[f].at_edge;
  }
  return faults;
}

std::vector<FaultMeter::Activation> FaultMeter::activation(const ContactState& state,
                                                           const Eigen::VectorXd* reference) const {
  std::vector<Activation> result(op_.geometry.faults.size());
  std::vector<double> place_slip(result.size(), 0);
  for (const Column& column : columns_) {
    Activation& a = result[static_cast<std::size_t>(column.fault)];
    ExtentFinder finder;
    const std::size_t n = column.nodes.size();
    double last = 0;
    bool any = false, first = false;
    int place = -1;
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double slip = slip_norm(column.nodes[i], state.jump, reference);
      first = first || (i == 0 && slip > slip_tolerance_);
      any = any || slip > slip_tolerance_;
      a.max_slip = std::max(a.max_slip, slip);
      if (slip > largest) {
        largest = slip;
        place = column.nodes[i];
      }
      const double from = i > 0 ? column.position[i - 1] : column.tip_before;
      if (!std::isnan(from))
        finder.add(i > 0 ? last : 0.0, slip, column.position[i] - from, slip_tolerance_);
      last = slip;
    }
    if (!any) continue;
    if (!std::isnan(column.tip_after)) {
      finder.add(last, 0.0, column.tip_after - column.position.back(), slip_tolerance_);
    }
    const Extent extent = finder.extent();
    a.length = std::max(a.length, extent.longest);
    if (extent.longest >= activation_length_) {
      a.activated = true;
      if (largest > place_slip[column.fault]) {
        place_slip[column.fault] = largest;
        a.place = place;
      }
      a.at_edge = a.at_edge || column.strike_edge || (first && !std::isnan(column.tip_before)) ||
                  (last > slip_tolerance_ && !std::isnan(column.tip_after));
      a.area += multiplicity_ * extent.total * column.width;
    }
  }
  return result;
}

}  // namespace faultsim
