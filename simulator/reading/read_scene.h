#pragma once

#include <map>
#include <string>
#include <vector>

#include "simulator/common/units.h"
#include "simulator/documents/json_document.h"
#include "simulator/scene/identity.h"
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
