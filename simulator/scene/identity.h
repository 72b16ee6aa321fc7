#pragma once

#include <string>

#include "simulator/scene/scene.h"

namespace faultsim {

/// The canonical text of the *resolved physical and numerical* scene: every default filled in, SI,
/// keys sorted, 1 = 1.0, -0 = 0, shortest round-trip numbers. Without title and outputs. A field
/// added later appears only when it differs from the value that reproduces the old behaviour.
std::string canonical_scene(const Scene& scene);
/// canonical_scene() in the parts that it is made of: the members of one JSON object.
struct CanonicalParts {
  std::string faults, geometry, initial_state, materials, mesh, numerics, pressure, stages;
  std::string creep;       ///< may be empty, as may be
  std::string block_edge;  ///< where a block's own overpressure jumps, and
  std::string fields;      ///< of flow simulators, and temperatures.
  std::string text() const;
};
CanonicalParts canonical_parts(const Scene& scene);
/// What is read, and written, together.
enum SceneSection : unsigned {
  kMaterials = 1,
  kGeometry = 2,
  kInitialState = 4,
  kFaults = 8,
  kLoading = 16,
  kAll = 63,  ///< and all the rest.
};
/// Writes again what follows from some sections of a scene.
void write_parts(const Scene& scene, unsigned sections, CanonicalParts& parts);
std::string case_identity(const CanonicalParts& parts);

/// Identity of a case: fingerprint of canonical_scene and kNumericsVersion.
std::string case_identity(const Scene& scene);
/// Whether identity is the scene's, under this or an earlier version of the numerics.
bool has_identity(const Scene& scene, const std::string& identity);

}  // namespace faultsim
