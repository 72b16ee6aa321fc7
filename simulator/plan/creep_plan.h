#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/plan/plan.h"

/// Whether viscous materials creep, and with which steps.
namespace faultsim {

/// How far viscous materials relax over the whole history, and what that may do to faults.
struct CreepEstimate {
  double relaxation_time = 0;  ///< τ = η/G, s, the shortest of the viscous materials in use.
  double duration = 0;         ///< T, s, of all stages.
  double relaxed_share = 0;    ///< 1 − exp(−T/τ), of a deviatoric stress at held strain.
  /// S, Pa, what loads may bring into the salt: the largest |Δp| of a region or fault, the largest
  /// boundary stress, the confined modulus times the largest boundary strain, and what slip and
  /// opening may release, the largest initial shear stress and the largest initial tension across a
  /// fault. Nothing where a face is translated.
  std::optional<double> stress;
  /// kCreepConcentration · S · relaxed share, Pa.
  std::optional<double> bound;
};

/// How much larger the change on a fault may be than S: edges of compartments, contrasts of
/// stiffness. On the reference scene it is 0.5 at first and 1.1 when all is relaxed; what the bound
/// ignores: docs/model.md, 9.
inline constexpr double kCreepConcentration = 10;

/// @pre has_viscous_material(scene).
CreepEstimate estimate_creep(const Scene& scene);

/// The reduction "creep_off": viscous materials are taken as elastic. Applied when switched off, or
/// when `automatic` and the bound is below a tenth of creep_tolerance.
Reduction plan_creep_off(const Scene& scene, const CreepEstimate& estimate);

/// The step lengths that creep needs, see CreepPlan::rungs.
std::vector<double> creep_rungs(const Scene& scene);

/// "creep: steps of 1 year, 182.6 days; 3 operators with the elastic one\n"; "" when not active.
std::string creep_text(const CreepPlan& creep);

}  // namespace faultsim
