#pragma once

#include <Eigen/Core>

#include "simulator/contact/contact_state.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// A load step as it was accepted: its data, and what is claimed to solve it.
struct AcceptedStep {
  Eigen::VectorXd locked_before, locked;  ///< t_L at its start and end, Pa; before step 0: zero.
  ContactState before, after;
  /// In one sub-step without a jump: then (5) holds from start to end of the step. Else only what
  /// the last state shows by itself is judged.
  bool at_once = true;
  /// The elastic operator relates locked traction and jump; not so where salt creeps or where
  /// there is no operator. Then tractions are taken as given.
  bool elastic = true;
};

/// By how much a step misses each condition, at the node that misses it most: ≥ 0, 0 is exact.
struct Misses {
  double equilibrium = 0;  ///< |t' as given − t'|, per component; only elastic.
  double tension = 0;      ///< t'_N where closed.
  double penetration = 0;  ///< −g_N H_NN/A.
  double over_limit = 0;   ///< |t'_T| − τ_L where closed.
  double below_limit = 0;  ///< τ_L − |t'_T| where closed and slipping: state slip, or Δg_T ≠ 0.
  double misaligned = 0;     ///< |t'_T − |t'_T| Δg_T/|Δg_T||; only at_once.
  double open_traction = 0;  ///< |t'| where open: state open, or g_N > 0.
  double memory = 0;  ///< of the path: |ΔL − |Δg_T|| H_TT/A; c where it is wrongly kept or lost.

  double largest() const;
};

/// The judgement of a step, in pascal and relative to the level of each node,
///
///   S_k = max(m_k, max_j m_j / 1000),   m_k = max of |t_L| and |t'| before and after and of
///                                             |t'_0 + t_L − t_L0|, over its components.
struct Verdict {
  Misses pascal;
  Misses relative;
  int node = -1;  ///< of the largest relative miss; −1: nothing is missed.
  /// ½ Σ A (t'_0 + t'_1)·Δg, tractions as given, against ½ Σ A (t_L0 + t_L1)·Δg −
  /// ½ (g_1ᵀ H g_1 − g_0ᵀ H g_0), relative to Σ A S |Δg| + 1e-6 ½ Σ |g_i H_ij g_j|; only elastic.
  double energy = 0;
  double negative_dissipation = 0;  ///< −t'_T·Δg_T / (S |Δg_T|) of the worst node; only at_once.
  double negative_energy = 0;       ///< −½ gᵀ H g over Σ |g_i H_ij g_j|; only elastic.

  double largest_energy() const;
  /// The worst of both, number by number.
  void take_worst(const Verdict& other);
};

/// Judges a step by the conditions themselves (docs/model.md, section 2), written down here a
/// second time. It sees data and solution only, no code of the solver and none of its friction
/// law: what the solver computes wrongly and believes is found here. With t' = t_L − A⁻¹ H g in
/// extended precision, at each node
///
///   t'_N ≤ 0,  g_N ≥ 0,  t'_N g_N = 0;     open: t' = 0;     closed: |t'_T| ≤ τ_L,
///   Δg_T = α t'_T,  α ≥ 0,  α (|t'_T| − τ_L) = 0,
///   τ_L = c − t'_N tan φ(s),   φ(s) = φ_s + (φ_d − φ_s) min(s/d_c, 1)   (or tan φ linear in s),
///   s = |g_T|, or the path L = Σ |Δg_T|;   c = 0 after opening, or after slip, where the law says.
///
/// The path of a step that was cut is at least |Δg_T|. A slip below 1e-6 S A/H_TT counts in
/// proportion where its direction matters: that is round-off. Without H (a compliance of size 0)
/// what H weighs, `penetration` and the path, is taken as if H_dd/A were 1 GPa/m.
/// @pre sizes agree with the operator (InternalError). Numbers that are not finite give infinity.
Verdict judge_step(const FaultOperator& op, const ContactLaws& laws, const AcceptedStep& step);

}  // namespace faultsim
