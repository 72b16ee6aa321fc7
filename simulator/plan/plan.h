#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulator/initial_state/initial_state.h"
#include "simulator/mesh/mesh.h"
#include "simulator/mesh/mesh_spec.h"
#include "simulator/plan/cost.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// How large a plan is, and what its operator is predicted to cost.
struct PlannedSize {
  long n_unknowns = 0;          ///< bulk and jump, estimated from the grid lines.
  double operator_seconds = 0;  ///< on one core of the calibration machine (results/plan).
  double memory_bytes = 0;      ///< peak while the operator is built.
};

/// One decision about what is modelled.
struct Reduction {
  std::string name;  ///< "half_domain", "plane_strain", "creep_off".
  bool applied = false;
  std::string reason;   ///< why it may, or may not, be used.
  std::string bound;    ///< what it can change in the answer; empty where it is not possible.
  std::string switch_;  ///< how to force it: "/numerics/half_domain".

  struct Saving {
    PlannedSize with, without;
  };
  std::optional<Saving> saving;  ///< see add_savings.
};

/// The steps of creep of viscous materials. Each needs a fault operator of its own besides the
/// elastic one, as the stiffness that a step sees depends on its length (docs/model.md, 14).
struct CreepPlan {
  bool active = false;
  /// Distinct step lengths Δt, s, descending; two that agree to 1e-9 are one. Error-controlled:
  /// D/2^k, k = 0 to creep_refinements, of each length D of a load step (those cut at
  /// turning points too);
  /// fixed: D/n with the least n that makes it at most creep_time_step. Empty when not active.
  std::vector<double> rungs;
  /// What creep may change of a fault traction, Pa (docs/model.md, section 9); nothing where no
  /// material is viscous or a load has no bound.
  std::optional<double> bound;
};

/// What will be modelled and what it costs: a pure function of the scene alone.
struct Plan : PlannedSize {
  bool half_domain = false;
  bool plane_strain = false;
  CreepPlan creep;
  std::vector<Reduction> reductions;
  long n_cells = 0;
  long n_jump = 0;
  int n_operators = 1;         ///< predicted, that a surface is built of, check points included.
  double factor_bytes = 0;     ///< predicted, of one operator's factor.
  double influence_bytes = 0;  ///< predicted, of the influence of cells; 0 without a field.
  int n_steps = 0;             ///< load steps after step 0.
  int n_added_steps = 0;  ///< of these, those that end at turning points between a stage's own.
  std::vector<InitialRegion> initial;  ///< the initial state per pressure region.
  std::vector<std::string> warnings;   ///< of the input, for who reads the plan; one sentence each.
  /// Where plane strain takes a flow result, one sentence each.
  std::vector<std::string> sections;
  std::string minus_side;  ///< of every fault: "x-", of smaller x; "" without faults.
  std::string family;      ///< fingerprint of what defines the linear bulk (without BLAS).
};

/// How many operators a surface is likely to take, check points included, by the number of its
/// parameters and its tolerance: within a factor of two. Ranges are not looked at.
int predicted_operators(const SurfaceRequest& surface);

/// Makes the plan. Geometry problems are appended with pointers into the scene document.
Plan make_plan(const Scene& scene, std::vector<Problem>& problems);

/// The same, where another sound scene's is known: where both differ in friction, pressure of
/// faults and initial state alone, and these leave the reductions as they were, only load steps are
/// counted again.
Plan make_plan(const Scene& scene, std::vector<Problem>& problems, const Scene& other,
               const Plan& of_other);

/// Plan::family without the rest of the plan: a fiftieth of the time.
std::string family_of(const Scene& scene);

/// The JSON text that Plan::family is the fingerprint of; numbers stand in it as the scene has
/// them.
std::string canonical_family(const Scene& scene, const Plan& plan);

/// What each reduction saves, or would save: the scene planned once more with and without it. None
/// where a reduction is not possible, or the scene cannot be planned the other way (a plane without
/// a cell size along strike).
void add_savings(const Scene& scene, Plan& plan);

/// What an influence block of n_cells cells costs on top of the plan's operator.
InfluenceCost plan_influence(const Scene& scene, const Plan& plan, long n_cells);

/// "49 % of the memory, 2.2 times less operator time".
std::string saving_text(const Reduction::Saving& saving);

/// The scene's mesh in numbers, as the plan reduces it. @pre geometry_kind agrees.
FieldMeshSpec field_mesh_spec(const Scene& scene, const Plan& plan);
BoxMeshSpec box_mesh_spec(const Scene& scene, const Plan& plan);
/// The mesh itself. Throws InputError where it cannot be made.
Mesh scene_mesh(const Scene& scene, const Plan& plan);

/// Name of the operator file: fingerprint of family, observation points, numerics version and BLAS.
std::string operator_fingerprint(const Scene& scene, const Plan& plan, const std::string& blas);

/// [{"region", "depth_m", "sigma_v_pa", "sigma_across_pa", "sigma_along_pa", "pressure_pa"}].
nlohmann::json initial_state_to_json(const std::vector<InitialRegion>& regions);
/// A line per region, bar, for the screen.
std::string initial_state_to_text(const std::vector<InitialRegion>& regions);

/// Which sides of the faults are called minus and plus: "minus is the side of smaller x (west)
/// ...".
std::string sides_to_text(const Plan& plan);

nlohmann::json plan_to_json(const Plan& plan);
std::string size_to_text(double bytes);      ///< "340 MB", "1.2 GB".
std::string plan_to_text(const Plan& plan);  ///< for the screen, with reasons.

}  // namespace faultsim
