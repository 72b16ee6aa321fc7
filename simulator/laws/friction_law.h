#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulator/laws/coulomb_law.h"

namespace faultsim {

/// What the friction of a point remembers of what it has been through.
struct FrictionState {
  Eigen::Vector2d slip{0, 0};  ///< g_T, m.
  double path = 0;             ///< Σ|Δg_T|, m.
  bool cohesive = true;        ///< cohesion, if it has any, is not lost.
};

/// The shear traction that a closed point carries at most, and its derivatives.
struct Strength {
  double value = 0;              ///< τ_L + η |Δg_T|/Δt, Pa.
  double d_normal = 0;           ///< ∂/∂t'_N = −tan φ, dimensionless.
  double d_measure = 0;          ///< ∂τ_L/∂s ≤ 0, Pa/m; right-hand at s = d_c (0).
  Eigen::Vector2d d_slip{0, 0};  ///< ∂/∂Δg_T, Pa/m.
};

/// The friction law of one fault point (docs/model.md, 4 and 6): the one place where the limit
/// shear traction and the slip measure are formed.
///
///   τ_L(t'_N, s) = c − t'_N tan φ(s),   φ(s) = φ_s + (φ_d − φ_s) min(s/d_c, 1)
///
/// or, for WeakeningLaw::coefficient, tan φ(s) = tan φ_s + (tan φ_d − tan φ_s) min(s/d_c, 1);
/// s = |g_T| at the end of the motion, or the length of its path when cumulated. A point that slips
/// by Δg_T in the time Δt carries η |Δg_T|/Δt more. Cohesion that is lost is taken off the sum, not
/// left out of it: the last digit steers how a jump goes, and with it the digits of results.
class NodeLaw {
 public:
  NodeLaw() : NodeLaw(CoulombLaw{}) {}  ///< no cohesion, no friction.
  explicit NodeLaw(const CoulombLaw& constants);

  /// After a motion from the state `before`.
  /// @param normal_traction  t'_N, Pa, effective, tension positive; > 0 counts as 0 (with
  /// derivative 0): whether the point is closed is for the active set. NaN gives NaN.
  /// @param slip_increment  Δg_T, m.  @param per_second  1/Δt; 0 = static.
  /// @param direction  of ∂s/∂Δg_T and of the rate where they have none: where s or Δg_T is 0.
  Strength strength(double normal_traction, const Eigen::Vector2d& slip_increment,
                    double per_second, const FrictionState& before,
                    const Eigen::Vector2d& direction = {0, 0}) const;
  /// τ_L of a state that stays as it is.
  double limit(double normal_traction, const FrictionState& state) const {
    return strength(normal_traction, {0, 0}, 0, state).value;
  }
  /// τ_L by φ_s, whatever the slip.
  double static_limit(double normal_traction, bool cohesive) const {
    return cohesion(cohesive) - std::min(normal_traction, 0.0) * static_friction_;
  }
  /// The state that a motion leaves. @param opened  the point was open on the way or is.
  FrictionState after(const FrictionState& before, const Eigen::Vector2d& slip_increment,
                      bool opened) const;

  /// W ≥ −dτ_L/d|Δg_T| ≥ 0 over the straight way of a motion, Pa/m.
  /// @param normal_traction  the lowest on the way.
  double fastest_weakening(double normal_traction, const Eigen::Vector2d& slip_increment,
                           const FrictionState& before) const;
  /// s of a state, m.
  double slip_measure(const FrictionState& state) const {
    return measure({0, 0}, state, {0, 0}).value;
  }
  bool weakens() const { return weakens_; }  ///< φ_d ≠ φ_s.
  bool is_fully_weakened(const FrictionState& state) const {
    return slip_measure(state) >= constants_.slip_weakening_distance;
  }
  /// Whether slip of a point in that state ends a cohesion it has.
  bool loses_cohesion_slipping(bool cohesive) const {
    return !constants_.cohesion_after_slip && cohesion(cohesive) > 0;
  }
  /// The law of a point that never had cohesion.
  NodeLaw without_cohesion() const {
    NodeLaw law = *this;
    law.constants_.cohesion = 0;
    return law;
  }
  double cohesion(bool cohesive) const { return cohesive ? constants_.cohesion : 0; }
  double static_friction() const { return static_friction_; }  ///< tan φ_s.
  /// η/Δt, Pa/m: what a rate adds to the shear traction of a point, open or closed, per slip.
  double drag(double per_second) const { return per_second * constants_.damping; }
  const CoulombLaw& constants() const { return constants_; }

 private:
  struct MeasuredSlip {
    double value;
    Eigen::Vector2d gradient;  ///< with respect to Δg_T.
  };
  MeasuredSlip measure(const Eigen::Vector2d& slip_increment, const FrictionState& before,
                       const Eigen::Vector2d& direction) const;
  Strength weakened(double normal_traction, const MeasuredSlip& s) const;

  CoulombLaw constants_;
  double static_friction_, dynamic_friction_;
  bool weakens_;
};

/// The laws of many points, each made once for all neighbours that share it: loops over points then
/// read few of them, and no angle is turned into its tangent twice.
class NodeLaws {
 public:
  NodeLaws() = default;
  explicit NodeLaws(std::span<const CoulombLaw> constants);
  const NodeLaw& operator[](std::size_t point) const { return laws_[number_[point]]; }
  bool any_weakens() const;

 private:
  std::vector<NodeLaw> laws_;
  std::vector<std::uint32_t> number_;  // of each point's law
};

inline Strength NodeLaw::strength(double normal_traction, const Eigen::Vector2d& slip_increment,
                                  double per_second, const FrictionState& before,
                                  const Eigen::Vector2d& direction) const {
  Strength at;
  if (weakens_) {
    at = weakened(normal_traction, measure(slip_increment, before, direction));
  } else {
    at.value = static_limit(normal_traction, true);
    at.d_normal = normal_traction > 0 ? 0 : -static_friction_;
  }
  if (!before.cohesive) at.value -= constants_.cohesion;
  if (per_second > 0) {
    const double slip = slip_increment.norm();
    at.value += drag(per_second) * slip;
    at.d_slip += drag(per_second) * (slip > 0 ? Eigen::Vector2d(slip_increment / slip) : direction);
  }
  return at;
}

/// Nucleation length of Uenishi and Rice: h_n = 1.157773883699 G*/W, W = −∂τ_L/∂s at onset, m;
/// infinity without weakening. @param modulus  G* = G/(1−ν) down dip (mode II), G along strike
/// (III).
double nucleation_length(double modulus, double weakening_rate);

}  // namespace faultsim
