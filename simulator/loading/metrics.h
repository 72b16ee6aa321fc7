#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/contact/contact.h"
#include "simulator/output/fault_operator.h"
#include "simulator/output/result.h"

namespace faultsim {

/// Point values of one load step, per fault node.
struct NodalState {
  Eigen::VectorXd shear;           ///< |t'_T|, Pa.
  Eigen::VectorXd strength;        ///< τ_L, current, Pa.
  Eigen::VectorXd critical_index;  ///< χ; 1 where open.
  Eigen::VectorXd static_critical_index;
  Eigen::VectorXd slip;  ///< |g_T|, m.
};

/// A strike column of a fault as profiles down dip, prepared once per operator.
struct Column {
  int fault;
  double width;                  ///< m.
  std::vector<int> nodes;        ///< fault nodes down dip.
  std::vector<double> position;  ///< s of each node, m from the column's first grid point.
  std::vector<double> share;     ///< tributary length of each node, m.
  double tip_before, tip_after;  ///< s of the unsplit ends (slip 0); NaN where the column is cut by
                                 ///< the body's boundary instead.
  bool strike_edge = false;      ///< the fault ends next to it along strike, inside the rock.
};

/// Metrics on the faults (design section 2). Profiles down dip are piecewise linear between nodes,
/// so that extents do not jump by cells; slip falls to 0 at unsplit edges.
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
    double area = 0;      ///< m2, of the extents in columns that satisfy the criterion.
    double max_slip = 0;  ///< m.
    bool activated = false;
    bool at_edge = false;  ///< an activated extent reaches a node next to an edge of the fault.
    int place = -1;        ///< node of largest slip in the columns that satisfy it; -1 = none does.
  };
  /// @param reference  jump at the reference time; nullptr = zero.
  std::vector<Activation> activation(const ContactState& state,
                                     const Eigen::VectorXd* reference) const;

  const std::vector<Column>& columns() const { return columns_; }
  /// The longest extent that slip could reach on a fault, m; 0 for a fault without nodes.
  double down_dip_length(int fault) const;

 private:
  double slip_norm(int node, const Eigen::VectorXd& jump, const Eigen::VectorXd* reference) const;
  void measure_columns(const NodalState& nodal, std::vector<FaultMetrics>& faults) const;

  const FaultOperator& op_;
  const ContactLaws& laws_;
  double slip_tolerance_;
  double activation_length_;
  double multiplicity_;  ///< 2 for a half domain: areas, potency, M0.
  std::vector<Column> columns_;
  std::vector<double> static_tangent_;  ///< tan φ_s per node.
  std::vector<char> weakens_;           ///< per node.
  std::vector<double> fault_area_;      ///< per fault, m2 (not doubled).
  std::vector<double> fault_width_;     ///< per fault, Σ column widths, m.
};

/// χ̄ of one column: max over windows of `length` of ∫|t'_T| ds / ∫τ_L ds, both linear between
/// nodes; the whole column when it is shorter.
double window_critical_index(const Column& column, const NodalState& nodal, double length);

/// Down-dip length of the column where the nodal profile exceeds a threshold, linear between nodes,
/// constant over the end half cells.
double length_above(const Column& column, const Eigen::VectorXd& profile, double threshold);

}  // namespace faultsim
