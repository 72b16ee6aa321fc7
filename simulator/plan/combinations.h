#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/scene.h"

namespace faultsim {

/// What a scene may have, and what may be asked of it, that not everything else goes with.
enum class Feature {
  creep,          ///< of viscous material.
  surface,        ///< operators interpolated over parameters.
  flow_result,    ///< pressures or temperatures cell by cell.
  temperature,    ///< of compartments.
  stress_change,  ///< of the region.
  half_domain,    ///< modelled by symmetry.
  plane_strain,
  weakening,      ///< friction that falls with slip: events.
  cohesion_loss,  ///< by the first slip.
  mesh,           ///< tetrahedra or hexahedra in place of a grid: from a file, or of horizons.
  // asked for
  coupled_path,
  displacements,    ///< of the whole mesh.
  contact_problem,  ///< of a load step, as a file.
  influences,       ///< of single cells, as a file.
};

/// Two features that do not go together, and why.
struct Refusal {
  Feature one, other;
  const char* reason;  ///< a sentence without its end, for messages and docs/combinations.md.
  const char* cure;
  bool depends_on_case = false;  ///< found where it shows, in these words, and not before.
};
/// All of them: whatever is not here runs, and tests/unit/app/combinations_test runs it.
std::span<const Refusal> refusals();

/// The features of a scene, by the plan of it.
std::vector<Feature> features_of(const Scene& scene, const Plan& plan);
/// The problems of all pairs of the scene's features, and of those asked for, that are refused, at
/// the places where the scene says the first one.
std::vector<Problem> unsupported(const Scene& scene, const Plan& plan,
                                 std::span<const Feature> asked = {});

/// The table of docs/combinations.md.
std::string combinations_table();

}  // namespace faultsim
