#pragma once

#include <string>
#include <utility>
#include <vector>

#include "simulator/documents/json_document.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {

inline constexpr double kDay = 86400;           // s
inline constexpr double kYear = 365.25 * kDay;  // s

/// A document read with some values set: (pointer or alias, text).
inline Scene varied(JsonDocument document,
                    const std::vector<std::pair<std::string, std::string>>& changes = {}) {
  for (const auto& [pointer, text] : changes) set_value(document, pointer, text);
  return read_scene(document);
}

/// The reference scene as it stands in the examples.
inline JsonDocument rotliegend() {
  return read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
}

}  // namespace faultsim
