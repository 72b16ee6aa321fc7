#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>
#include <vector>

namespace faultsim {

/// The parts of a draft-07 schema that speak about one value, outermost first: the schema itself,
/// what its `$ref` and `allOf` lead to, and the branch of `if` that the value takes. Annotations
/// next to a `$ref` count (validators ignore them, people write them).
using SchemaViews = std::vector<const nlohmann::json*>;

/// @param root   the whole schema, where "#/definitions/..." is looked up.
/// @param value  the value at hand; decides the branch of `if`.
SchemaViews schema_views(const nlohmann::json& root, const nlohmann::json& schema,
                         const nlohmann::json& value);
/// Views of member `key` of an object (by `properties`, else `additionalProperties`) or of element
/// `key` of an array; empty when the schema does not know it.
SchemaViews child_views(const nlohmann::json& root, const SchemaViews& parent,
                        const std::string& key, const nlohmann::json& value);
/// The first view that has the keyword, its value; nullptr if none.
const nlohmann::json* keyword(const SchemaViews& views, const char* name);
/// The keyword as text, "" if none.
std::string keyword_text(const SchemaViews& views, const char* name);
/// Names of all `properties` of the views, sorted, without "comment".
std::vector<std::string> known_keys(const SchemaViews& views);
/// The `enum` of the views as texts.
std::vector<std::string> enum_texts(const SchemaViews& views);

/// Calls visit(pointer, value, views) for every value, parents first.
using SchemaVisitor = std::function<void(const std::string& pointer, const nlohmann::json& value,
                                         const SchemaViews& views)>;
void walk_schema(const nlohmann::json& root, const nlohmann::json& value,
                 const SchemaVisitor& visit);

/// The pointers of problems, in which it takes one look to see whether there is one at or below a
/// place, however many there are.
class Ancestry {
 public:
  void add(std::string pointer);
  bool contains(const std::string& pointer) const { return places_.count(pointer) != 0; }

 private:
  std::unordered_set<std::string> places_;  ///< the pointers and all above them.
};

/// Key as one token of a JSON Pointer ('~' and '/' escaped).
std::string pointer_token(const std::string& key);
/// The value as it stands in the file, shortened for messages.
std::string as_text(const nlohmann::json& value);

}  // namespace faultsim
