#pragma once

#include "simulator/scene/json_document.h"

namespace faultsim {

/// The reference scene as it stands in the examples.
inline JsonDocument rotliegend() {
  return read_json_file(FAULTSIM_SOURCE_DIR "/docs/examples/scenes/rotliegend.json");
}

}  // namespace faultsim
