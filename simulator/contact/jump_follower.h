#pragma once

#include <optional>

#include "simulator/contact/contact_report.h"
#include "simulator/contact/sub_step_solver.h"

namespace faultsim {

/// Follows the faults at fixed load from the last equilibrium before an instability to the next
/// stable one, by quasi-dynamics with radiation damping (Rice, J. Geophys. Res. 98, 1993): a node
/// that slips at the rate v carries
///
///   |t'_T| = τ_L(t'_N, s) + η v,   η = G/2c_s,   v = |Δg_T|/Δt
///
/// (backward Euler); a node that is open carries t'_N = 0 and t'_T = η Δg_T/Δt. Δt follows the
/// slip: small enough that the damped tangent is stable and that no node weakens by more than a
/// share of d_c at once, growing as the motion dies. The jump has ended when a static solution
/// follows with every state on the way shown stable.
///
/// Where the tangent never loses stability and no cohesion is lost, the way was continuous and
/// merely hard to find: the state is advanced, but no jump is reported.
class JumpFollower {
 public:
  explicit JumpFollower(SubStepSolver& solver) : solver_(solver) {}

  struct Report {
    bool arrived = false;
    std::optional<ContactJump> jump;  ///< evidence; also of a jump that did not arrive.
    SolveCounts counts;
  };
  /// @param from, to  load factors: state is the last equilibrium, at `from`; the load is held at
  /// `to`. @param budget  Newton iterations after which it gives up. @param state  moved to the new
  /// equilibrium; undefined when not arrived.
  Report follow(const LoadPath& path, double from, double to, int budget, ContactState& state);

 private:
  int stiffest_by_bounds() const;
  double first_duration() const;
  bool damped_step(const LoadPath& path, double from, ContactState& state);
  bool try_static(const LoadPath& path, ContactState& state);
  bool still_weakens(int k) const;
  double weakening_share() const;
  double hop_share() const;
  void note_stability();
  void note_lost_cohesion();
  void add_energy();

  SubStepSolver& solver_;
  Report report_;
  ContactJump evidence_;
  double load_ = 0;
  double duration_ = 0;
  int negative_now_ = 0;
};

}  // namespace faultsim
