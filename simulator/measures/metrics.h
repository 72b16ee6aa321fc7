#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "simulator/contact/contact.h"
#include "simulator/measures/profile_measures.h"
#include "simulator/model/fault_operator.h"
#include "simulator/result/result.h"

namespace faultsim {

/// Activation of a fault by slip since some time: extent, area, flag.
struct Activation {
  double length = 0;    ///< m, longest down-dip extent with slip > tolerance.
  double area = 0;      ///< m2, of the extents in profiles that satisfy the criterion.
  double max_slip = 0;  ///< m.
  bool activated = false;
  /// The flag does not depend on the mesh. Not resolved: extents that reach the activation length
  /// or not depending on where in a cell slip ends, and faults that do not reach it but where χ̄
  /// may be 1 within its error.
  bool resolved = true;
  bool at_edge = false;  ///< an activated extent reaches a node next to an edge of the fault.
  int place = -1;        ///< node of largest slip in the profiles that satisfy it; -1 = none does.
};

/// Point values of one load step, per fault node, and what follows from them alone.
struct NodalState {
  Eigen::VectorXd shear;           ///< |t'_T|, Pa.
  Eigen::VectorXd strength;        ///< τ_L, current, Pa; at least 1 kPa.
  Eigen::VectorXd critical_index;  ///< χ; 1 where open.
  Eigen::VectorXd static_critical_index;
  Eigen::VectorXd slip;                 ///< |g_T|, m.
  std::vector<WindowIndex> window;      ///< χ̄ per profile, fault by fault.
  std::vector<char> near_activation;    ///< per profile: it may slide on a finer mesh.
  std::vector<Activation> since_start;  ///< per fault, by all slip.
};

/// Metrics on the faults (docs/model.md, section 7).
class FaultMeter {
 public:
  FaultMeter(const FaultOperator& op, const ContactLaws& laws, double slip_tolerance,
             double activation_length);

  void evaluate(const ContactState& state, NodalState& nodal) const;

  /// All metrics of every fault; `before` is the jump at the start of the step.
  std::vector<FaultMetrics> measure(const NodalState& nodal, const ContactState& state,
                                    const Eigen::VectorXd& before) const;

  /// Activation of one fault by slip since `reference`, the jump then; empty = zero.
  /// @param nodal  of this state.
  Activation activation(int fault, const NodalState& nodal, const ContactState& state,
                        const Eigen::VectorXd& reference) const;

  /// The longest extent that slip could reach on a fault, m; 0 for a fault without nodes.
  double down_dip_length(int fault) const;

 private:
  /// A profile of a fault, and how its windows are found.
  struct Line {
    int fault;
    const Profile& profile;
    double length;  ///< m, the longest extent that slip could reach.
    WindowSearch windows;
  };
  /// What is asked of a node at every step, side by side.
  struct Node {
    std::array<int, 3> dof;
    double area;             ///< m2, doubled for a half domain.
    double moment_per_slip;  ///< area G_eff, N.
  };
  void evaluate_node(std::size_t k, const ContactState& state, NodalState& nodal) const;
  void measure_profiles(const NodalState& nodal, std::vector<FaultMetrics>& faults) const;
  Activation activation_by(int fault, const NodalState& nodal, const Eigen::VectorXd& slip) const;
  bool near_activation(const Line& line, const WindowIndex& window, const NodalState& nodal,
                       const ContactState& state) const;

  const FaultOperator& op_;
  NodeLaws laws_;
  double slip_tolerance_;
  double activation_length_;
  double multiplicity_;  ///< 2 for a half domain: areas, potency, M0.
  std::vector<Node> nodes_;
  std::vector<Line> lines_;              ///< fault by fault.
  std::vector<std::size_t> first_line_;  ///< per fault, and the end.
  std::vector<double> fault_area_;       ///< per fault, m2 (not doubled).
  std::vector<double> fault_width_;      ///< per fault, Σ widths of profiles, m.
};

}  // namespace faultsim
