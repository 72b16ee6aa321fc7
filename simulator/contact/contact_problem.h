#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "simulator/contact/contact.h"

namespace faultsim {

/// What the contact loops need of a node, flat.
struct ContactNode {
  std::array<int, 3> dof = {-1, -1, -1};  ///< n, then the shear dofs that exist.
  int n_dofs = 0;                         ///< 1 + number of shear dofs.
  std::array<double, 3> inverse_area{};   ///< 1/A per dof, 1/m2.
  double friction = 0;                    ///< tan φ_s.
  bool weakens = false;                   ///< φ_d < φ_s.
};

/// The constants of one case: operator, laws, and both flattened per node.
class ContactProblem {
 public:
  /// @pre sizes agree, normal dofs exist, areas > 0 (InternalError).
  ContactProblem(const FaultOperator& fault_operator, const ContactLaws& contact_laws);

  int n_nodes() const { return static_cast<int>(nodes.size()); }
  int n_dofs() const { return static_cast<int>(inverse_area.size()); }
  /// τ_L and derivatives; normal tractions > 0 count as 0 (with derivative 0).
  LimitShearTraction strength(int node, bool cohesive, double normal_traction, double slip) const;
  /// η of a node, Pa s/m; 0 where the laws give none.
  double damping(int node) const { return laws.damping.size() > 0 ? laws.damping[node] : 0; }
  /// H_dd / A, Pa/m, of component c of a node. Read on demand: columns of nodes at rest stay
  /// unread.
  double stiffness(const ContactNode& node, int component) const;
  /// traction −= A⁻¹ H jump over the columns with jump ≠ 0. Cost 2 n_dofs per such column.
  void subtract_product(const Eigen::VectorXd& jump, Eigen::VectorXd& traction);

  const FaultOperator& op;
  const ContactLaws& laws;
  std::vector<ContactNode> nodes;
  Eigen::VectorXd inverse_area;  ///< per dof.
  bool any_weakening = false;
  bool may_jump = false;  ///< some strength falls with slip: by weakening or by lost cohesion.
  bool scalar = true;     ///< at most one shear dof per node and no weakening anywhere.

 private:
  Eigen::VectorXd product_;
  std::vector<int> columns_;
};

/// A sub-step being solved: locked traction in, motion and traction out.
struct SubStep {
  const ContactState* start = nullptr;  ///< where the sub-step starts; not changed.
  Eigen::VectorXd trial;                ///< t' if nothing moves, Pa.
  Eigen::VectorXd locked;               ///< t_L at the end of the sub-step, Pa.
  Eigen::VectorXd increment;            ///< Δg, m.
  Eigen::VectorXd traction;             ///< t' = trial − A⁻¹ H Δg, Pa.
  std::vector<FaultState> state;
  std::vector<char> cohesive;  ///< cohesion counts at this node.
  Eigen::VectorXd tolerance;   ///< per node, Pa.
  /// 1/Δt of a damped sub-step, 1/s: τ_L grows by η |Δg_T|/Δt; 0 = static.
  double damping_per_second = 0;
};

/// Shear components of a dof vector at a node; missing ones are 0.
inline Eigen::Vector2d shear_part(const ContactNode& node, const Eigen::VectorXd& values) {
  return {node.n_dofs > 1 ? values[node.dof[1]] : 0, node.n_dofs > 2 ? values[node.dof[2]] : 0};
}

/// The slip measure s at the end of a sub-step and its gradient with respect to Δg_T.
struct SlipMeasure {
  double value;
  Eigen::Vector2d gradient;
};
/// s = |g_T0 + Δg_T|, or path0 + |Δg_T| when cumulated. @param direction  the gradient where s has
/// none.
SlipMeasure slip_measure(bool cumulated, double path_before, const Eigen::Vector2d& slip_before,
                         const Eigen::Vector2d& slip_increment, const Eigen::Vector2d& direction);

/// Whether a node slips in the sub-step that still has cohesion and loses it by slip.
bool loses_cohesion(const ContactProblem& problem, const SubStep& sub_step, int node);

/// Why a node is not in equilibrium, as the report counts it.
struct NodeViolation {
  double tension = 0;      ///< t'_N over closed, Pa.
  double penetration = 0;  ///< −g_N, as a traction by the local stiffness, Pa.
  double over_limit = 0;   ///< |t'_T| − τ_L, Pa.
  double below_limit = 0;  ///< τ_L − |t'_T| where it slips, Pa.
  double misaligned = 0;   ///< ||t'_T| Δg_T − t'_T |Δg_T|| / |Δg_T|, Pa.
  double open_traction = 0;
  double worst() const;
};
/// Checks (3)–(5) at one node straight from their definition, with nothing from the solver's
/// residual.
NodeViolation check_node(const ContactProblem& problem, const SubStep& sub_step, int node);

}  // namespace faultsim
