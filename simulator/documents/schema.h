#pragma once

#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "simulator/documents/json_document.h"

namespace faultsim {

struct SchemaRules;

/// The parts of a schema that speak about one value, outermost first: the schema itself, what its
/// `$ref` and `allOf` lead to, and the branch of `if` that the value takes.
using SchemaViews = std::vector<const SchemaRules*>;

/// What one part of a schema demands. As draft-07 has it, the keywords next to a `$ref` demand
/// nothing; annotations there count (validators ignore them, people write them).
struct SchemaRules {
  const nlohmann::json* text = nullptr;     ///< as written, for annotations.
  unsigned types = ~0U;                     ///< set of 1 << json::value_t.
  const nlohmann::json* only = nullptr;     ///< const.
  const nlohmann::json* allowed = nullptr;  ///< enum.
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
  /// Characters of a text, elements of a list, entries of an object.
  std::size_t min_length = 0, max_length = ~std::size_t{0};
  std::size_t min_items = 0, max_items = ~std::size_t{0};
  std::size_t min_entries = 0, max_entries = ~std::size_t{0};
  bool unique_items = false;
  bool closed = false;  ///< no keys but those of properties.
  std::vector<std::string> required;
  std::map<std::string, const SchemaRules*, std::less<>> properties;
  const SchemaRules* additional = nullptr;  ///< of the other keys.
  const SchemaRules* items = nullptr;
  std::vector<const SchemaRules*> parts;  ///< what `$ref` and `allOf` lead to.
  const SchemaRules* condition = nullptr;
  const SchemaRules* then = nullptr;
  const SchemaRules* otherwise = nullptr;
  SchemaViews views;  ///< of every value, where there is no `if` on the way; else empty.
};

/// A draft-07 schema, looked up once. Refuses keywords that it does not know (InternalError), so
/// that no rule is written in vain.
class Schema {
 public:
  explicit Schema(nlohmann::json text);
  Schema(const Schema&) = delete;
  Schema& operator=(const Schema&) = delete;

  const nlohmann::json& text() const { return text_; }
  const SchemaRules& root() const { return *root_; }

 private:
  const SchemaRules* rules_of(const nlohmann::json& part);
  void read_keyword(const std::string& name, const nlohmann::json& value, SchemaRules& rules);

  const nlohmann::json text_;
  std::deque<SchemaRules> all_;
  std::unordered_map<const nlohmann::json*, SchemaRules*> by_part_;
  const SchemaRules* root_ = nullptr;
};

/// Where a value stands while a document is walked; its pointer is written where it is needed.
struct ValuePlace {
  const ValuePlace* parent = nullptr;
  const std::string* key = nullptr;  ///< in an object.
  std::size_t index = 0;             ///< in a list.
  std::string pointer() const;
};
using SchemaVisitor = std::function<void(const ValuePlace& place, const nlohmann::json& value,
                                         const SchemaViews& views)>;

/// Validates: one problem per mistake, sorted by line, with "did you mean" for unknown keys and
/// words. Texts and keys that a terminal would obey (common/printable.h) are problems wherever they
/// stand, except in comments.
/// @param visit  called for every value that the schema speaks about, children first.
std::vector<Problem> check_schema(const JsonDocument& document, const Schema& schema,
                                  const SchemaVisitor& visit = {});

/// The same of some members of a document alone.
std::vector<Problem> check_members(const JsonDocument& document, const Schema& schema,
                                   std::span<const std::string> members,
                                   const SchemaVisitor& visit);

/// @param value  decides the branches of `if`.
SchemaViews schema_views(const SchemaRules& rules, const nlohmann::json& value);
/// Views of a member of an object (by `properties`, else `additionalProperties`), of an element of
/// a list; empty when the schema does not know it. @param scratch  may hold the result.
const SchemaViews& member_views(const SchemaViews& parent, const std::string& key,
                                const nlohmann::json& value, SchemaViews& scratch);
const SchemaViews& item_views(const SchemaViews& parent, const nlohmann::json& value,
                              SchemaViews& scratch);

/// Whether a number or text is of the type and in the range that its views demand.
bool accepts_alone(const SchemaViews& views, const nlohmann::json& value);

/// The first view that has the keyword, its value; nullptr if none.
const nlohmann::json* keyword(const SchemaViews& views, const char* name);
/// The keyword as text, "" if none.
std::string keyword_text(const SchemaViews& views, const char* name);
/// All names in `properties`, sorted, without "comment".
std::vector<std::string> known_keys(const SchemaViews& views);
std::vector<std::string> enum_texts(const SchemaViews& views);

/// The pointers of problems, in which it takes one look to see whether there is one at or below a
/// place, however many there are.
class Ancestry {
 public:
  void add(std::string pointer);
  bool contains(const std::string& pointer) const { return places_.count(pointer) != 0; }

 private:
  std::unordered_set<std::string> places_;  ///< the pointers and all above them.
};

/// The value as it stands in the file, shortened for messages.
std::string as_text(const nlohmann::json& value);

}  // namespace faultsim
