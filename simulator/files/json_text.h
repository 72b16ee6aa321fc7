#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace faultsim {

/// What a command prints with --json: an object with the number of its format, indented, with a
/// line end. Objects that have a "format" keep it; the others get 1. schemas/commands.schema.json
/// says what each command prints. Control characters in texts are escaped, what is not UTF-8 is
/// replaced.
std::string json_text(nlohmann::ordered_json document);
std::string json_text(nlohmann::json document);

}  // namespace faultsim
