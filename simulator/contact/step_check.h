#pragma once

#include <Eigen/Core>
#include <string>

#include "simulator/contact/contact.h"

namespace faultsim {

/// A load step as it was accepted, seen from outside the solver.
struct AcceptedStep {
  Eigen::VectorXd locked_before, locked;  ///< t_L at its start and end, Pa; before step 0: zero.
  ContactState before, after;
  /// In one sub-step without a jump: then (5) holds from start to end of the step. Else only what
  /// the last state shows by itself is checked.
  bool at_once = true;
  /// The elastic operator relates locked traction and jump; not so where salt creeps.
  bool elastic = true;
};

/// How far an accepted step is from (3)–(5) and (9), computed anew in extended precision from H,
/// the locked traction and the jumps: tractions are recomputed, t' = t_L − A⁻¹ H g (without
/// `elastic` they are taken as given). Tractions are relative to the level of the node,
///
///   S_k = max(m_k, max_k m_k / 1000),   m_k = max of |t_L|, |t'| before and after and of the
///                                             traction if nothing had moved, over its components,
///
/// energies to Σ A S |Δg| + 1e-6 ½ Σ |g_i H_ij g_j|. All ≥ 0, 0 is exact.
struct StepCheck {
  double equilibrium = 0;    ///< |t' − (t_L − A⁻¹ H g)|.
  double tension = 0;        ///< t'_N of closed nodes.
  double penetration = 0;    ///< −g_N H_NN/A.
  double over_limit = 0;     ///< |t'_T| − τ_L of closed nodes.
  double below_limit = 0;    ///< τ_L − |t'_T| of nodes that slipped; only at_once.
  double misaligned = 0;     ///< |t'_T − |t'_T| Δg_T/|Δg_T||; only at_once. Slips below
                             ///< 1e-6 |t'_T| A/H_TT count in proportion: round-off.
  double open_traction = 0;  ///< |t'| of open nodes and of gaps.
  /// ½ Σ A (t'_0 + t'_1)·Δg against ½ Σ A (t_L0 + t_L1)·Δg − ½ (g_1ᵀ H g_1 − g_0ᵀ H g_0), with
  /// the tractions as reported; only elastic.
  double energy = 0;
  double negative_dissipation = 0;  ///< −A t'_T·Δg_T of the worst node; only at_once.
  double negative_energy = 0;       ///< −½ gᵀ H g over Σ |g_i H_ij g_j|; only elastic.

  double largest_residual() const;  ///< of equilibrium and contact: all but energies.
  double largest_energy() const;
  /// The worst of both, number by number.
  void take_worst(const StepCheck& other);
};

/// @pre sizes agree with the operator (InternalError). Numbers that are not finite give infinity.
StepCheck check_step(const FaultOperator& op, const ContactLaws& laws, const AcceptedStep& step);

}  // namespace faultsim
