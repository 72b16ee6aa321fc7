#pragma once

#include <string_view>
#include <vector>

/// Inside of reading: which keys of a fault say where it is. One list for the reader, the
/// parameters and the body that is built of them.
namespace faultsim {

/// Of bodies of a kind ("field", "box", "mesh", "horizons"); none of other words.
const std::vector<std::string_view>& place_keys(std::string_view kind);

/// Of bodies of any kind, each once.
const std::vector<std::string_view>& all_place_keys();

}  // namespace faultsim
