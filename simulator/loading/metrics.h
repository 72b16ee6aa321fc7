#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/contact/contact.h"
#include "simulator/loading/profile_measures.h"
#include "simulator/model/fault_operator.h"
#include "simulator/output/result.h"

namespace faultsim {

/// Point values of one load step, per fault node.
struct NodalState {
  Eigen::VectorXd shear;           ///< |t'_T|, Pa.
  Eigen::VectorXd strength;        ///< τ_L, current, Pa; at least 1 kPa.
  Eigen::VectorXd critical_index;  ///< χ; 1 where open.
  Eigen::VectorXd static_critical_index;
  Eigen::VectorXd slip;             ///< |g_T|, m.
  std::vector<WindowIndex> window;  ///< χ̄ per profile, fault by fault.
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

  /// Activation by slip since `reference`: extent, area, flag.
  struct Activation {
    double length = 0;    ///< m, longest down-dip extent with slip > tolerance.
    double area = 0;      ///< m2, of the extents in profiles that satisfy the criterion.
    double max_slip = 0;  ///< m.
    bool activated = false;
    /// The flag does not hang on the mesh. Not resolved: extents that reach the activation length
    /// or not depending on where in a cell slip ends, and faults that do not reach it but where χ̄
    /// may be 1 within its error.
    bool resolved = true;
    bool at_edge = false;  ///< an activated extent reaches a node next to an edge of the fault.
    int place = -1;  ///< node of largest slip in the profiles that satisfy it; -1 = none does.
  };
  /// @param nodal  of this state.
  /// @param reference  jump at the reference time; nullptr = zero.
  std::vector<Activation> activation(const NodalState& nodal, const ContactState& state,
                                     const Eigen::VectorXd* reference) const;

  /// The longest extent that slip could reach on a fault, m; 0 for a fault without nodes.
  double down_dip_length(int fault) const;

 private:
  /// A profile of a fault, and how its windows are found.
  struct Line {
    int fault;
    const Profile& profile;
    WindowSearch windows;
  };
  double slip_norm(int node, const Eigen::VectorXd& jump, const Eigen::VectorXd* reference) const;
  void measure_profiles(const NodalState& nodal, std::vector<FaultMetrics>& faults) const;
  bool near_activation(const Profile& profile, const WindowIndex& window, const NodalState& nodal,
                       const ContactState& state) const;

  const FaultOperator& op_;
  NodeLaws laws_;
  double slip_tolerance_;
  double activation_length_;
  double multiplicity_;  ///< 2 for a half domain: areas, potency, M0.
  std::vector<Line> lines_;
  std::vector<double> fault_area_;   ///< per fault, m2 (not doubled).
  std::vector<double> fault_width_;  ///< per fault, Σ widths of profiles, m.
};

}  // namespace faultsim
