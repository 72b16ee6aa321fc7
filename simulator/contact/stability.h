#pragma once

#include "simulator/contact/bordered_lu.h"
#include "simulator/contact/contact_problem.h"

namespace faultsim {

/// Whether a slip patch that weakens stays stable on the whole way through a sub-step.
struct StabilityReport {
  bool checked = false;  ///< some slipping node weakens.
  bool stable = true;
  int n_slipping = 0;
  int node = -1;     ///< where W A/H is largest among the slipping nodes.
  double ratio = 0;  ///< that W A/H: 1 = the node alone would be unstable.
};

/// Tests the tangent of the moving nodes with the fastest weakening met in the sub-step,
///
///   M = d_i·(A⁻¹H)_TT d_j + tan φ_i (A⁻¹H)_NT d_j − W_i δ_ij,   d = Δg_T/|Δg_T|,   W ≥
///   −dτ_L/d|Δg_T|,
///
/// scaled by A, with the dofs of open nodes appended. All pivots positive means that every state
/// passed is stable: a smaller patch is a leading block of a reordering, and less weakening adds a
/// positive diagonal. A converged state that fails may still be stable; then the caller takes a
/// smaller sub-step, on which W is closer to the truth. Damping adds a positive diagonal η/Δt.
/// Negative pivots that are there without
/// weakening (strong coupling with the normal traction) are not held against weakening.
class StabilityCheck {
 public:
  explicit StabilityCheck(const ContactProblem& problem) : problem_(problem) {}
  StabilityReport check(const SubStep& sub_step);
  /// Negative pivots of the undamped tangent at the end of the sub-step, with the weakening there.
  int negative_pivots(const SubStep& sub_step);

 private:
  enum class Where { fastest_on_the_way, at_the_end };
  struct Mover {
    int node;
    int open_component;  ///< −1: slips.
    Eigen::Vector2d direction;
    double friction, weakening;
    double damping;  ///< η/Δt, Pa/m.
  };
  void collect(const SubStep& sub_step, Where where, StabilityReport& report);
  void assemble();
  int count_negative_pivots(bool with_weakening, bool damped);

  const ContactProblem& problem_;
  std::vector<Mover> movers_;
  Eigen::MatrixXd tangent_;
  BorderedLu lu_;
};

}  // namespace faultsim
