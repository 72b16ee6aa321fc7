#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>

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
/// Reads and parses a regular file; a missing or unreadable file is an InputError too. Of a page
/// (*.html) the scene that it holds, with the lines that it has there.
JsonDocument read_json_file(const std::string& path);
/// The element in which a page holds its scene.
inline constexpr std::string_view kSceneElement = "<script type=\"application/json\" id=\"scene\">";

/// Replaces the value at pointer by value, as `--set /json/pointer=value` does: text that parses as
/// JSON is taken as such, else as a string. Missing objects on the
/// way are made, and whether a key may be there is left for the schema to judge; elements of lists
/// must exist. Throws InputError naming the pointer.
void set_value(JsonDocument& document, const std::string& pointer, const std::string& value);

/// The text as a value, as `--set` takes it: what parses as JSON as such, else as a string. Throws
/// InputError with `pointer` where it holds a control character.
nlohmann::json value_of_text(const std::string& text, const std::string& source,
                             const std::string& pointer);

/// Key as one token of a JSON Pointer ('~' and '/' escaped).
std::string pointer_token(const std::string& key);
/// Pointer to an element of a list.
inline std::string element(const std::string& list, std::size_t i) {
  return list + "/" + std::to_string(i);
}
/// The value at pointer, nullptr if there is none. Takes a tenth of the time of nlohmann's, which
/// reads the pointer first.
const nlohmann::json* value_at(const nlohmann::json& document, std::string_view pointer);
/// A member by its token, an element by its number.
const nlohmann::json* child_at(const nlohmann::json& parent, std::string_view token);
/// A value in place of the one at a pointer.
struct PlacedValue {
  std::string pointer;
  nlohmann::json value;
};
/// Puts value at pointer; missing objects on the way are made. False where a list has no such
/// element or something else stands in the way.
bool put_value(nlohmann::json& document, std::string_view pointer, nlohmann::json value);

}  // namespace faultsim
