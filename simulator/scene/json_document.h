#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "simulator/common/errors.h"

namespace faultsim {

/// A JSON text with the line of every value, so that messages can point into the file.
struct JsonDocument {
  std::string source;  ///< file name, for messages.
  nlohmann::json value;
  std::unordered_map<std::string, int> lines;  ///< JSON Pointer -> line, from 1.

  /// Line of the value at pointer, or of the nearest ancestor that has one; 0 if none.
  int line_of(const std::string& pointer) const;
};

/// Parses text. Refuses with InputError (line and column): syntax errors, duplicate keys, depth
/// > 64, more than 64 MB, pointers of more than 500 bytes, more than 2 million values, numbers that
/// overflow a double.
JsonDocument parse_json(std::string_view text, const std::string& source);
/// Reads and parses a regular file; a missing or unreadable file is an InputError too.
JsonDocument read_json_file(const std::string& path);

/// Replaces the value at pointer by value, as `--set /json/pointer=value` does: text that parses as
/// JSON is taken as such, else as a string. Missing objects on the
/// way are made, and whether a key may be there is left for the schema to judge; elements of lists
/// must exist. Throws InputError naming the pointer.
void set_value(JsonDocument& document, const std::string& pointer, const std::string& value);

/// Validates against a draft-07 schema (valijson) and returns one problem per mistake: the deepest
/// error per pointer, with "did you mean" for unknown keys and enum values. Texts and keys that a
/// terminal would obey (common/printable.h) are problems wherever they stand, except in comments.
std::vector<Problem> check_schema(const JsonDocument& document, const nlohmann::json& schema);

}  // namespace faultsim
