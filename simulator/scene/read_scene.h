#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/units.h"
#include "simulator/scene/json_document.h"
#include "simulator/scene/scene.h"

namespace faultsim {

class Schema;

/// The schema of scenes, embedded from schemas/scene.schema.json.
const Schema& scene_schema();

/// Turns a document into a checked Scene: schema, units, defaults, tier, meaning (names that must
/// exist, ranges, geometry, p < 0 with depth and step). Relative CSV paths are taken from the
/// folder of document.source. Throws InputError with *all* problems.
Scene read_scene(const JsonDocument& document);

/// The same without throwing: problems are appended; the scene is meaningful only if none were.
Scene read_scene(const JsonDocument& document, std::vector<Problem>& problems);

/// The canonical text of the *resolved physical and numerical* scene: every default filled in, SI,
/// keys sorted, 1 = 1.0, -0 = 0, shortest round-trip numbers. Without title and outputs. A field
/// added later appears only when it differs from the value that reproduces the old behaviour.
std::string canonical_scene(const Scene& scene);
/// canonical_scene() in the parts that it is made of: the members of one JSON object.
struct CanonicalParts {
  std::string faults, geometry, initial_state, materials, mesh, numerics, pressure, stages;
  std::string creep;   ///< may be empty, as may be
  std::string fields;  ///< of flow simulators, and temperatures.
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

/// One row of `faultsim parameters`.
struct ParameterInfo {
  std::string pointer;  ///< JSON Pointer into the scene's document.
  std::string alias;    ///< short name for campaigns: "friction_angle"; may be empty.
  Dimension dimension = Dimension::number;
  std::string value;  ///< as given in this scene, or the default.
  std::string default_value;
  std::string range;        ///< "[0 deg, 80 deg]".
  bool new_family = false;  ///< changing it costs a new operator.
  std::string description;
  bool is_text = false;  ///< a word (or true, false) out of range "{mean, min, ...}", no number.
};

/// All numbers and words of this scene that can be varied, in document order; optional ones that it
/// does not give too, with their defaults (set_value can set them).
std::vector<ParameterInfo> parameters(const JsonDocument& document);

/// The short names of a document: alias -> pointer ("offset" -> "/geometry/blocks/1/offset"). A
/// pointer may have several.
std::map<std::string, std::string> parameter_aliases(const JsonDocument& document);

/// The pointer of an alias in this document ("offset" -> "/geometry/blocks/1/offset"), or the text
/// itself when it starts with '/'. Throws InputError with near misses.
std::string resolve_parameter(const JsonDocument& document, const std::string& alias_or_pointer);

/// A commented starter scene (valid JSON) for `faultsim init`: kind "field" or "box".
std::string starter_scene(const std::string& kind);

}  // namespace faultsim
