#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "simulator/contact/contact_state.h"
#include "simulator/laws/friction_law.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// What the contact loops need of a node, flat and small: they go over all nodes.
struct ContactNode {
  std::array<int, 3> dof = {-1, -1, -1};  ///< n, then the shear dofs that exist.
  int n_dofs = 0;                         ///< 1 + number of shear dofs.
  std::array<double, 3> inverse_area{};   ///< 1/A per dof, 1/m2.
  const NodeLaw* law = nullptr;           ///< of the problem.
};

/// The constants of one case: operator, laws, and both flattened per node.
class ContactProblem {
 public:
  /// @pre sizes agree, normal dofs exist, areas > 0 (InternalError).
  ContactProblem(const FaultOperator& fault_operator, const ContactLaws& contact_laws,
                 ThreadTeam* shared_by = nullptr);
  ContactProblem(const ContactProblem&) = delete;  // nodes point to its laws

  int n_nodes() const { return static_cast<int>(nodes.size()); }
  int n_dofs() const { return static_cast<int>(inverse_area.size()); }
  /// H_dd / A, Pa/m, of component c of a node. Read on demand: columns of nodes at rest stay
  /// unread.
  double stiffness(const ContactNode& node, int component) const;
  /// traction −= A⁻¹ H jump over the columns with jump ≠ 0, in the rows given. Cost 2 rows per such
  /// column.
  void subtract_product(const Eigen::VectorXd& jump, std::span<const RowRange> rows,
                        Eigen::VectorXd& traction);
  /// In all rows.
  void subtract_product(const Eigen::VectorXd& jump, Eigen::VectorXd& traction) {
    const RowRange all{0, n_dofs()};
    subtract_product(jump, {&all, 1}, traction);
  }

  const FaultOperator& op;
  ThreadTeam* const team;  ///< that shares long products; null: none. Bits do not depend on it.
  const Compliance& compliance;  ///< op's H.
  NodeLaws laws;
  std::vector<ContactNode> nodes;
  Eigen::VectorXd inverse_area;  ///< per dof.
  bool may_jump = false;  ///< some strength falls with slip: by weakening or by lost cohesion.
  bool scalar = true;     ///< at most one shear dof per node and no weakening anywhere.

 private:
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
  double per_second = 0;       ///< 1/Δt of a damped sub-step, 1/s; 0 = static.
};

/// Shear components of a dof vector at a node; missing ones are 0.
inline Eigen::Vector2d shear_part(const ContactNode& node, const Eigen::VectorXd& values) {
  return {node.n_dofs > 1 ? values[node.dof[1]] : 0, node.n_dofs > 2 ? values[node.dof[2]] : 0};
}

/// What the friction of a node remembers at the start of a sub-step, its cohesion as it is now.
inline FrictionState friction_before(const ContactNode& node, const SubStep& sub_step, int k) {
  return {shear_part(node, sub_step.start->jump), sub_step.start->slip_path[k],
          sub_step.cohesive[k] != 0};
}
/// The strength of a node at the end of a sub-step.
inline Strength strength_after(const ContactNode& node, const SubStep& sub_step, int k) {
  const Eigen::Vector2d slip = shear_part(node, sub_step.increment);
  return node.law->strength(sub_step.traction[node.dof[0]], slip, sub_step.per_second,
                            friction_before(node, sub_step, k), slip);
}

/// Whether a node slips in the sub-step that still has cohesion and loses it by slip.
bool loses_cohesion(const ContactProblem& problem, const SubStep& sub_step, int k);

/// The larger; NaN where either is, which std::max may hide.
inline double worse(double a, double b) { return std::isnan(a) || a >= b ? a : b; }

/// Why a node is not in equilibrium, as the report counts it.
struct NodeViolation {
  double tension = 0;      ///< t'_N over closed, Pa.
  double penetration = 0;  ///< −g_N, as a traction by the local stiffness, Pa.
  double over_limit = 0;   ///< |t'_T| − τ_L, Pa.
  double below_limit = 0;  ///< τ_L − |t'_T| where it slips, Pa.
  double misaligned = 0;   ///< ||t'_T| Δg_T − t'_T |Δg_T|| / |Δg_T|, Pa.
  double open_traction = 0;
  double worst() const;  ///< NaN where any is.
  /// worst() in units of a tolerance, which may be 0; without any violation 0.
  double over(double tolerance) const { return worst() == 0 ? 0 : worst() / tolerance; }
};
/// Checks (3)–(5) at one node, with nothing from the solver's residual but with its friction law:
/// by this a step is accepted. What judges from outside is judge.h.
NodeViolation check_node(const ContactProblem& problem, const SubStep& sub_step, int k);

}  // namespace faultsim
