#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/words.h"
#include "simulator/result/measures.h"

/// The result of one case as plain structs. NaN never reaches a file: a missing value is an empty
/// optional, written as null with a reason where one is known. SI throughout.
namespace faultsim {

/// How a load step or a case ended. The default is `failed`: forgetting to set it is not a success.
enum class Outcome {
  failed,            ///< internal trouble; see reason.
  converged,         ///< every load step is in equilibrium within tolerance.
  event,             ///< in equilibrium too, after one or more recorded slip events.
  unresolved_event,  ///< a case of that kind whose cells are too coarse for its weakening, so that
                     ///< the size of its events is the mesh's.
  unconverged,       ///< a load step did not converge; the history ends before it.
  unstable,     ///< equilibrium jumped and the jump was not followed; the history ends before it.
  interrupted,  ///< stopped by a signal or a limit.
};
/// Whether a step ended in equilibrium, or all steps of a case did.
inline bool in_equilibrium(Outcome outcome) {
  return outcome == Outcome::converged || outcome == Outcome::event ||
         outcome == Outcome::unresolved_event;
}
constexpr auto words(Outcome) {
  return std::array{"failed",      "converged", "event",      "unresolved_event",
                    "unconverged", "unstable",  "interrupted"};
}

enum class FaultState : int { stick = 0, slip = 1, open = 2 };
constexpr auto words(FaultState) { return std::array{"stick", "slip", "open"}; }

/// Metrics of one fault at one load step. Definitions: docs/model.md, section 7.
struct FaultMetrics {
  double chi_bar = 0;         ///< χ̄, window maximum of ∫|t'_T| / ∫τ_L; mesh-independent.
  double chi_max = 0;         ///< nodal max χ: mesh-dependent.
  double chi_static_max = 0;  ///< nodal max χ_s, against the static strength.
  double area_chi_080 = 0;    ///< m2 with χ > 0.8.
  double thickness_chi_080_max = 0;  ///< m, longest down-dip length with χ > 0.8 over the profiles.
  double thickness_chi_080_mean = 0;  ///< m, strike mean of that length.
  double slipping_area = 0;           ///< m2 of nodes in state slip in this step.
  double open_area = 0;               ///< m2.
  double activated_area = 0;    ///< m2: slip since start > slip_tolerance in profiles that satisfy
                                ///< the activation length.
  double activated_length = 0;  ///< m, longest down-dip extent with slip > slip_tolerance.
  bool activated = false;       ///< activated_length ≥ activation_length.
  bool activation_resolved = true;  ///< that flag does not depend on the cells (docs/model.md).
  bool activated_at_edge = false;   ///< activated next to an edge of the fault: it might go on.
  double max_slip = 0;              ///< m, |g_T| since start.
  double mean_slip = 0;             ///< m, over the fault's area.
  double potency = 0;               ///< m3 (plane strain: per metre of strike, m3/m).
  double moment = 0;                ///< M0, N m (plane strain: N m per metre of strike).
  double moment_step = 0;           ///< ∫ G_eff |Δg_T| dA of this step alone, N m.

  bool operator==(const FaultMetrics&) const = default;  ///< the very same numbers.
};

/// How hard the contact solve worked; regression-tested counts.
struct SolveCounts {
  int newton_iterations = 0;
  int active_set_passes = 0;
  int sub_steps = 0;
  int wasted_newton_iterations = 0;  ///< in sub-steps that were thrown away.
};

/// What the creep of salt did to one fault up to the end of a step: t'_creep = t' − (t_L − A⁻¹ H g)
/// with the elastic operator, that is, the traction beyond what pressure and slip alone would give.
struct FaultCreep {
  double normal_min = 0;  ///< Pa, most compressive change of t'_N by creep; ≤ 0.
  double normal_max = 0;  ///< Pa, most tensile one; ≥ 0.
  double shear_max = 0;   ///< Pa, largest |change of t'_T|.

  bool operator==(const FaultCreep&) const = default;  ///< the very same numbers.
};

/// How a step with creeping salt was walked, and what the salt did to the faults.
struct StepCreep {
  int time_steps = 0;     ///< that the step was divided into.
  double time_error = 0;  ///< Pa, largest change of fault traction when a time step was halved.
  /// Within /numerics/creep_tolerance wherever it was measured; false also where only the shortest
  /// steps have an answer, without a jump.
  bool time_resolved = true;
  std::vector<FaultCreep> faults;
};

/// What the linear solver of the coupled path did in a load step (docs/model.md, section 11).
struct StepCoupled {
  std::vector<int> krylov_iterations;  ///< of GMRES, per Newton iteration, tries in vain included.
  double setup_seconds = 0;            ///< of the processor, for preconditioners; not compared.
  double solve_seconds = 0;            ///< of the processor, in GMRES; not compared.
};

/// The same over a case.
struct CaseCoupled {
  std::string leading, schur;  ///< names of the preconditioner's two parts.
  int n_displacements = 0;     ///< unknowns, both sides of the faults.
  int n_multipliers = 0;       ///< where all nodes stick.
  int krylov_iterations = 0;
  int most_krylov_iterations = 0;  ///< of one Newton iteration.
  double setup_seconds = 0;        ///< of the processor; not compared.
  double solve_seconds = 0;        ///< of the processor; not compared.

  void add(const StepCoupled& step);
};

/// The surface that a case's operator was interpolated on, and how far it was off the exact
/// operators at check points that are none of its nodes: the largest relative error there.
struct CaseSurface {
  int n_operators = 0;     ///< nodes.
  int n_basis = 0;         ///< columns that are left of them.
  int n_checks = 0;        ///< check points.
  double tolerance = 0;    ///< that was asked for; without cases all errors are below.
  double stiffness = 0;    ///< of H, in the Frobenius norm.
  double traction = 0;     ///< of the worst locked traction.
  double observation = 0;  ///< of the observation rows; 0 without.
  double slip = 0;         ///< of slip of faults without friction under the worst load.
  /// Of the weakening with slip at which a fault becomes unstable (surface/stability_limit.h): what
  /// the onset of events hangs on. Beside the tolerance; none where it was not measured.
  std::optional<double> stability = {};
  /// Of cases run on both at half of the check points, which others than they decided on
  /// (numerics/surface/probes): how many, and how far off they were at most. None where the
  /// tolerance is that of operators.
  int n_cases = 0;
  std::optional<double> chi_tolerance = {};  ///< that was asked for.
  std::optional<double> chi_bar = {};        ///< |Δχ̄| of a fault at a load step.
  std::optional<double> largest_slip = {};   ///< of a fault at a load step, relative to the case's.
  std::optional<int> flags_that_differ =
      {};  ///< of those that say whether a fault slides in a stage.

  bool operator==(const CaseSurface&) const = default;  ///< the very same numbers.
};

struct StepResult {
  int step = 0;                         ///< 0 = initial equilibrium.
  std::string stage;                    ///< "initial" for step 0.
  double time = 0;                      ///< s.
  std::vector<double> pressure_change;  ///< Pa, per region, in region order.
  /// K, likewise, of a flow result its mean; empty where no temperature changes.
  std::vector<double> temperature_change;
  Outcome outcome = Outcome::failed;
  std::string reason;  ///< why not converged: counts per reason and the worst node.
  int n_stick = 0, n_slip = 0, n_open = 0;
  std::vector<FaultMetrics> faults;
  std::vector<double> observed;        ///< m, per observation row.
  std::optional<StepCreep> creep;      ///< only where salt creeps.
  std::optional<StepCoupled> coupled;  ///< only on the coupled path.
  SolveCounts counts;
  double seconds = 0;  ///< wall; not compared.
};

/// Pressures of a fault at one of its places: of the regions (compartments) on either side, that
/// is, of the region that touches the fault on that side nearest to the place, none where no region
/// does; and of the fluid in the fault itself.
struct SidePressures {
  std::string region_minus, region_plus;                ///< "" = none.
  std::optional<double> change_minus, change_plus;      ///< Pa, Δp since the start.
  std::optional<double> absolute_minus, absolute_plus;  ///< Pa, p0 + Δp, p0 of the region's fluid
                                                        ///< at the depth of the place.
  double change_in_fault = 0;                           ///< Pa, Δp_f at the place.

  bool operator==(const SidePressures&) const = default;  ///< the very same numbers.
};
/// Δp, or absolute pressure, of the side that changed more (the minus side if alike); none where no
/// region touches the fault.
std::optional<double> leading_change(const SidePressures& sides);
std::optional<double> leading_absolute(const SidePressures& sides);

/// When and where something happens first on a fault.
struct FaultOnset {
  int step = 0;
  double depth = 0;         ///< m, where it is largest then; datum of the absolute pressures.
  SidePressures pressures;  ///< at the end of the step; with a bracket, at its end.
  /// The bracket (Numerics::activation_tolerance), by load factors of the step: it was seen not to
  /// slide yet at the one, and to slide at the other.
  std::optional<double> load_before = {}, load_after = {};
  /// Pa, Δp at load_before of the side that leading_change() is of; of the fault's fluid where no
  /// region touches it.
  std::optional<double> change_before = {};

  bool operator==(const FaultOnset&) const = default;  ///< the very same numbers.
};

/// A jump of equilibrium within a load step, followed to the next equilibrium (docs/model.md,
/// section 2), with its evidence. Values cover all faults that moved; plane strain: per metre of
/// strike.
struct SlipEvent {
  int step = 0;
  std::string stage;
  double load_factor_before = 0;    ///< of the load step, where the last equilibrium was found;
  double load_factor_after = 0;     ///< the load at which the jump was followed.
  double time = 0;                  ///< s, of onset.
  std::string fault;                ///< where it nucleated.
  double depth = 0;                 ///< m, of the centre of the nucleus.
  SidePressures pressures;          ///< beside the nucleus at onset.
  double nucleation_length = 0;     ///< m, down-dip, slipping and weakening as stability is lost.
  double slipped_area = 0;          ///< m2.
  double max_slip = 0;              ///< m, of the event.
  double mean_slip = 0;             ///< m, over the slipped area.
  double stress_drop = 0;           ///< Pa, of shear traction along the slip, weighted by slip.
  double potency = 0;               ///< m3.
  double moment = 0;                ///< M0, N m.
  std::optional<double> magnitude;  ///< Mw; none in plane strain.
  double duration = 0;              ///< s, of the radiation-damped motion.
  bool resolved = true;             ///< cell edges ≤ h_n / 3 where it slipped.
  int negative_pivots = 0;          ///< of the tangent on the way; 0 before and after.
  int n_lost_cohesion = 0;          ///< nodes that lost their cohesion by slipping.
  double residual_before = 0;       ///< largest violation of (3)–(5), in units of the tolerance.
  double residual_after = 0;
  double energy_released = 0;    ///< J, by bulk and loads.
  double energy_dissipated = 0;  ///< J, by friction; the rest is radiated.
  bool evidence_holds = false;   ///< stability lost in between, equilibrium before and after,
                                 ///< energy released ≥ dissipated ≥ 0.

  bool operator==(const SlipEvent&) const = default;  ///< the very same numbers.
};

/// A run of consecutive load steps of one stage, all before or all after the recovery of the
/// fault's pressure, in which the fault slips or is open, and slides (meets the activation
/// criterion).
struct Episode {
  std::string stage;
  std::string fault;
  int first_step = 0, last_step = 0;
  double depth = 0;             ///< m, where its slip is largest.
  SidePressures pressures;      ///< there, at the end of its first step.
  bool after_recovery = false;  ///< the fault's pressure was depleted, and had been lower.
  double activated_area = 0;    ///< m2, by the slip of the episode.
  double max_slip = 0;          ///< m, of the episode.
  double moment = 0;            ///< M0, N m, summed over its steps.
  std::optional<double> magnitude_if_at_once;  ///< Mw if all of it were one event: slow slip has no
                                               ///< magnitude. None in plane strain.

  bool operator==(const Episode&) const = default;  ///< the very same numbers.
};

/// The evidence of an unexpected reactivation (docs/words.md): a fault slides after its pressure
/// has recovered that slid before the recovery.
struct Reactivation {
  int episode = 0;  ///< number from 1 of the first such one in CaseResult::episodes.
  int after = 0;    ///< that of the last one of the same fault before the recovery.

  bool operator==(const Reactivation&) const = default;
};

/// Fault fields of one load step, per fault node of FaultGeometry (fault frame).
struct FaultFields {
  Eigen::Matrix3Xd traction;              ///< t' effective (n, strike, dip), Pa.
  Eigen::Matrix3Xd jump;                  ///< g (g_N, slip strike, slip dip), m.
  Eigen::VectorXd critical_index;         ///< χ.
  Eigen::VectorXd static_critical_index;  ///< χ_s.
  Eigen::VectorXi state;                  ///< FaultState.
  Eigen::VectorXd fault_pressure_change;  ///< Δp_f, Pa.
  Eigen::Matrix3Xd creep_traction;        ///< t'_creep (n, strike, dip), Pa; empty without creep.
};

/// Measures of one fault over one stage, or over the whole case.
struct FaultStageMetrics : Measures {
  std::string fault;
  std::optional<FaultOnset> activation;  ///< iff activated: first step, place of largest slip.
  std::optional<FaultOnset> opening;     ///< iff opens: first step, place of largest gap.

  bool operator==(const FaultStageMetrics&) const = default;  ///< the very same numbers.
};

/// Measures of one stage (its steps together), of all faults; the same per case are "whole".
struct StageMetrics : Measures {
  std::string stage;  ///< "" for the whole case.
  int first_step = 0, last_step = 0;
  std::optional<int> activation_step;          ///< first step with the criterion met.
  std::string activated_fault;                 ///< the first fault that slides; "" if none.
  std::optional<int> opening_step;             ///< first step with an open node.
  std::string opened_fault;                    ///< the first fault that opens; "" if none.
  std::optional<double> magnitude_if_at_once;  ///< Mw if all its slip were one event; none where
                                               ///< moment = 0 or plane strain.
  std::vector<FaultStageMetrics> faults;       ///< in the order of the scene.

  bool operator==(const StageMetrics&) const = default;  ///< the very same numbers.
};
/// Onset on the first fault that slides, or opens; nullptr if none does.
const FaultOnset* first_activation(const StageMetrics& stage);
const FaultOnset* first_opening(const StageMetrics& stage);

struct CaseResult {
  std::string title;
  std::string identity;  ///< case_identity of the scene.
  std::string operator_fingerprint;
  int numerics_version = 0;
  Outcome outcome = Outcome::failed;
  std::string reason;              ///< empty when converged.
  std::optional<int> failed_step;  ///< where the history ends, when it ends early.
  bool plane_strain = false;
  bool weakening_resolved =
      true;  ///< cell edges ≤ h_n / 3 where it slips (true without weakening).
  double max_nucleation_ratio = 0;  ///< largest edge / h_n over slipping nodes.
  double max_penetration = 0;       ///< m, largest −g_N of any step; 0 up to the tolerance.
  double pressure_margin = std::numeric_limits<double>::quiet_NaN();
  ///< Pa of further depletion scale to χ̄ = 1 by linear
  ///< extrapolation for cases in which no fault slides or opens; NaN = null.
  std::vector<std::string> region_names;
  std::vector<std::string> fault_names;
  std::vector<std::string> observation_names;
  std::vector<StepResult>
      steps;  ///< step 0 first; only steps in equilibrium, plus the failed one
              ///< (outcome != converged, metrics of the last iterate not given).
  std::vector<StageMetrics> stages;
  StageMetrics whole;
  std::vector<SlipEvent> events;           ///< in order of time.
  std::vector<Episode> episodes;           ///< in order of time.
  std::optional<Reactivation> unexpected;  ///< the first unexpected reactivation.
  SolveCounts counts;
  std::optional<CaseCoupled> coupled;  ///< only on the coupled path.
  std::optional<CaseSurface> surface;  ///< only where the operator is interpolated.
  /// Share of the compartments' volume that its flow result covers, [0, 1]; of pressure and
  /// temperature the smaller one. Only of a scene with a flow result.
  std::optional<double> field_coverage;
  /// Share of the integral of |Δp| or |ΔT| over the compartments at the last report that is assumed
  /// as it lies beyond that, [0, 1]; of pressure and temperature the larger one. Likewise.
  std::optional<double> field_assumed;
  std::vector<std::string> warnings;
  double seconds = 0;  ///< wall; not compared.
};

/// Mw = (2/3)(log10 M0 − 9.1); none for M0 ≤ 0.
std::optional<double> moment_magnitude(double moment);

}  // namespace faultsim
