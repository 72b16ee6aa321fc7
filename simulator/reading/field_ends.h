#pragma once

#include <optional>
#include <string>

#include "simulator/reading/scene_reader.h"

/// Inside of reading: where blocks and faults of a field end along strike.
namespace faultsim {

/// What an object says of its ends along y: "y_from" and "y_to", or "length", centred on y = 0.
/// Ends that are those of all others say nothing, so that equal scenes stay equal.
/// @param at      pointer to the object and a slash.
/// @param whose   for messages: "block \"west\"".
/// @param length  that of all others, m.
/// @param y_from, y_to  read already; in: what is given, out: what differs from ∓length/2.
void read_field_ends(SceneReader& reader, const std::string& at, const std::string& whose,
                     double length, std::optional<double>& y_from, std::optional<double>& y_to);

/// The keys that say it.
inline constexpr const char* kEndKeys[] = {"y_from", "y_to", "length"};

/// That the ends that an object says lie in the model. @param at  pointer to it and a slash.
void check_field_ends(SceneReader& reader, const std::string& at, const FieldGeometry& field);

}  // namespace faultsim
