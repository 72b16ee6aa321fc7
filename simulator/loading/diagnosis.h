#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "simulator/contact/judge.h"
#include "simulator/loading/run_case.h"

namespace faultsim {

/// Above these a case is not sound. Relative numbers.
struct DiagnosisLimits {
  double residual = 1e-7;  ///< of a step and of its energies; times traction_tolerance / 1e-8.
  double asymmetry = 1e-12;
  double condition = 1e10;
  double noise_change = 1e-6;  ///< of χ̄ and slip, by noise of 1e-12.
};

/// H of (9): symmetric, positive definite, how well conditioned.
struct OperatorCheck {
  double asymmetry = 0;  ///< max |H − Hᵀ| / max |H|.
  std::optional<double>
      condition;  ///< of A^(−1/2) H A^(−1/2), 1-norm; none: not positive definite.
};
OperatorCheck check_operator(const FaultOperator& op);

/// What a disturbance of every locked traction t_L by ± noise · t_L changes.
struct NoiseCheck {
  static constexpr double kNoise = 1e-12;
  double chi_bar_change = 0;  ///< largest over faults and steps, relative to max(1, χ̄).
  double slip_change = 0;     ///< of the largest slip of a fault, relative to that of the case.
  std::vector<std::string> changed;  ///< what must not depend on it but did: "outcome: ..."
  double change() const { return std::max(chi_bar_change, slip_change); }
  double amplification() const { return change() / kNoise; }
};
/// Compares a case with its disturbed twin, step by step as far as both go.
NoiseCheck compare_with_twin(const CaseResult& result, const CaseResult& twin);

/// A limit that is not met, and whether the result says so itself (by outcome or warning).
struct Violation {
  std::string what;
  bool told = false;
};

/// A case run, judged step by step from outside, and run again with disturbed loads.
struct Diagnosis {
  CaseResult result;
  OperatorCheck op;     ///< elastic operator.
  Verdict worst;        ///< over all steps in equilibrium.
  int worst_step = -1;  ///< of the largest residual; −1 without steps.
  int n_steps = 0;      ///< in equilibrium.
  int n_elastic = 0;  ///< of those, with equilibrium and energy recomputed (not while salt creeps).
  int n_at_once = 0;  ///< of those, with the flow rule checked (not cut, no event).
  double seconds = 0;  ///< wall, of the first run.
  NoiseCheck noise;
  std::vector<Violation> violations;
  bool sound() const { return violations.empty(); }
};

/// Runs the case twice and checks it. Interrupted runs are as run_case() leaves them.
Diagnosis diagnose_case(const Scene& scene, const PreparedOperator& prepared,
                        const RunContext& context, const DiagnosisLimits& limits = {});

/// The verdict on numbers at hand; sets diagnosis.violations.
void judge(const DiagnosisLimits& limits, double traction_tolerance, Diagnosis& diagnosis);

}  // namespace faultsim
