#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "simulator/documents/json_document.h"
#include "simulator/scene/scene.h"

/// What a surface of operators may be over, and the cases that say when it is fine enough.
namespace faultsim {

/// Which parameter of a surface a pointer is, without its range; none where a surface cannot be
/// over it.
std::optional<SurfaceParameter> surface_parameter(const std::string& pointer, const Scene& scene);

/// The cases of /numerics/surface/probes as values put into the document, aliases resolved; a case
/// that is no object has none.
std::vector<std::vector<PlacedValue>> surface_probes(const JsonDocument& document);

/// Of the cases, and of all in the document that neither they nor the surface's parameters put
/// values in the place of: scenes that differ in these alone have the same cases.
/// @param replaced  pointers to what cases have values for, and to the surface's parameters.
std::string fingerprint_of_probes(const JsonDocument& document,
                                  const std::set<std::string>& replaced);

/// The scene of the i-th of them, with the surface's parameters as they are in `at` and without a
/// surface. Throws InputError where it is no sound scene.
/// @param document  of a scene with such cases. @param at  of the same family.
Scene probing_scene(const JsonDocument& document, std::size_t i, const Scene& at,
                    const std::vector<SurfaceParameter>& over);

}  // namespace faultsim
