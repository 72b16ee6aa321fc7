#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "simulator/common/fingerprint.h"
#include "simulator/common/printable.h"
#include "simulator/scene/json_document.h"
#include "simulator/scene/near_miss.h"
#include "simulator/scene/schema_walk.h"

/// valijson says which values are wrong; this file says it in words a user can act on, from the
/// same schema. One problem per mistake: valijson also reports every parent of a wrong value.
namespace faultsim {
namespace {

using nlohmann::json;

/// valijson compares each element with each other: fine for the lists that make sense, minutes for
/// 10^5 elements. Beyond this length equal elements are looked for here.
constexpr std::size_t kPairsUpTo = 64;

bool has_long_array(const json& value) {
  if (value.is_array() && value.size() > kPairsUpTo) return true;
  return value.is_structured() && std::any_of(value.begin(), value.end(), has_long_array);
}

json without_unique_items(json schema) {
  if (schema.is_object()) schema.erase("uniqueItems");
  if (schema.is_structured()) {
    for (json& part : schema) part = without_unique_items(std::move(part));
  }
  return schema;
}

/// Schemas as valijson wants them, made once per process and text.
const valijson::Schema& compiled(const json& schema, bool unique_items) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<valijson::Schema>> cache;
  const std::lock_guard lock(mutex);
  auto& entry = cache[fingerprint(schema.dump()) + (unique_items ? "" : " without unique items")];
  if (!entry) {
    const json used = unique_items ? schema : without_unique_items(schema);
    entry = std::make_unique<valijson::Schema>();
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(used), *entry);
  }
  return *entry;
}

/// "<root>", "[faults]", "[0]" -> "/faults/0".
std::string pointer_of(const std::vector<std::string>& context) {
  std::string pointer;
  for (std::size_t i = 1; i < context.size(); ++i) {
    pointer += "/" + pointer_token(context[i].substr(1, context[i].size() - 2));
  }
  return pointer;
}

struct Place {
  const json* value;
  SchemaViews views;
};

std::unordered_map<std::string, Place> places_of(const JsonDocument& document, const json& schema) {
  std::unordered_map<std::string, Place> places;
  walk_schema(schema, document.value,
              [&](const std::string& pointer, const json& value, const SchemaViews& views) {
                places[pointer] = {&value, views};
              });
  return places;
}

std::string type_words(const json& types) {
  static const std::map<std::string, std::string> words = {{"object", "an object {...}"},
                                                           {"array", "a list [...]"},
                                                           {"string", "a text"},
                                                           {"number", "a number"},
                                                           {"integer", "a whole number"},
                                                           {"boolean", "true or false"},
                                                           {"null", "null"}};
  if (types.is_string()) return words.at(types.get<std::string>());
  std::string text;
  for (const auto& type : types) {
    text += (text.empty() ? "" : " or ") + words.at(type.get<std::string>());
  }
  return text;
}

std::string range_words(const SchemaViews& views) {
  const json* least = keyword(views, "minimum");
  const json* most = keyword(views, "maximum");
  if (least != nullptr && most != nullptr) {
    return "outside [" + least->dump() + ", " + most->dump() + "]";
  }
  return least != nullptr ? "below " + least->dump() : "above " + keyword_text(views, "maximum");
}

/// "write <example>" where the schema has one.
std::string example_cure(const SchemaViews& views, const std::string& otherwise) {
  if (const std::string cure = keyword_text(views, "x-cure"); !cure.empty()) return cure;
  if (const json* examples = keyword(views, "examples")) {
    return "write for example " + examples->at(0).dump();
  }
  return otherwise;
}

class Explainer {
 public:
  Explainer(const JsonDocument& document, const json& schema)
      : document_(document), schema_(schema), places_(places_of(document, schema)) {}

  void explain(const std::string& pointer, const std::string& description) {
    const Place& place = places_.at(pointer);
    const json& value = *place.value;
    const SchemaViews& views = place.views;
    const auto says = [&](const char* text) { return description.find(text) != std::string::npos; };
    if (says("Object contains a property that could not be validated")) {
      explain_unknown_keys(pointer, place);
    } else if (says("Missing required property")) {
      const auto quote = description.find('\'');
      const std::string key = description.substr(quote + 1, description.rfind('\'') - quote - 1);
      missing_[pointer].insert(key);
    } else if (says("'type' constraint")) {
      const json* types = keyword(views, "type");
      const bool quantity = keyword(views, "x-dimension") != nullptr;
      const std::string wanted = quantity ? "a number with a unit, as text"
                                          : type_words(types == nullptr ? json("object") : *types);
      add(pointer, as_text(value) + " is not " + wanted, example_cure(views, "write " + wanted));
    } else if (says("enum values") || says("'const' constraint")) {
      std::vector<std::string> allowed = enum_texts(views);
      if (const json* only = keyword(views, "const")) allowed = {only->dump()};
      const std::string word = value.is_string() ? value.get<std::string>() : "";
      add(pointer, as_text(value) + " is not known here",
          example_cure(views, may_suggest() ? suggest(word, allowed) : "write a word it knows"));
    } else if (says("Expected number")) {
      add(pointer, as_text(value) + " is " + range_words(views),
          example_cure(views, "write a number in the range"));
    } else if (says("Array should contain")) {
      const json* wanted = keyword(views, says("no more") ? "maxItems" : "minItems");
      add(pointer, concat("has ", value.size(), " elements"),
          concat("write ", says("no more") ? "at most " : "at least ", *wanted));
    } else if (description.rfind("Failed to validate", 0) == 0) {
      wrappers_.push_back(pointer);
    } else if (says("no fewer than")) {
      add(pointer, as_text(value) + " is too short", example_cure(views, "fill it in"));
    } else if (says("no more than") && value.is_string()) {
      add(pointer, as_text(value) + " is too long",
          "write at most " + keyword_text(views, "maxLength") + " characters");
    } else if (says("no more than")) {
      add(pointer, concat("has ", value.size(), " entries"),
          "write at most " + keyword_text(views, "maxProperties"));
    } else if (says("Elements at indexes")) {
      add(pointer, as_text(value) + " has equal elements", "remove one of them");
    } else {
      add(pointer, as_text(value) + ": " + description, "see the schema");
    }
  }

  std::vector<Problem> finish() {
    for (const auto& [pointer, keys] : missing_) explain_missing(pointer, keys);
    Ancestry explained;
    for (const Problem& problem : problems_) explained.add(problem.pointer);
    for (const std::string& pointer : wrappers_) {
      if (!explained.contains(pointer)) {
        add(pointer, as_text(*places_.at(pointer).value) + " does not fit the schema",
            "see the schema");
      }
    }
    return std::move(problems_);
  }

 private:
  void add(const std::string& pointer, const std::string& what, const std::string& cure) {
    if (!reported_.insert(pointer).second) return;
    problems_.push_back({pointer, document_.line_of(pointer), what, cure});
  }

  /// Once per object: valijson tells of every such key.
  void explain_unknown_keys(const std::string& pointer, const Place& place) {
    if (!keys_explained_.insert(pointer).second) return;
    const std::vector<std::string> known = known_keys(place.views);
    std::vector<std::string> free;
    for (const std::string& name : known) {
      if (!place.value->contains(name)) free.push_back(name);
    }
    for (const auto& [key, inner] : place.value->items()) {
      if (key == "comment" || std::binary_search(known.begin(), known.end(), key)) continue;
      if (may_suggest()) misspelt_[pointer].insert(near_miss(key, free));
      add(pointer + "/" + pointer_token(key), "\"" + key + "\" is not a key of this object",
          may_suggest() ? suggest(key, free) : "remove it");
    }
  }
  /// After so many problems nobody reads near misses, and looking for them takes time.
  bool may_suggest() const { return problems_.size() < kMostSuggestions; }

  /// Keys that are there but misspelt are one mistake, reported where they stand.
  void explain_missing(const std::string& pointer, const std::set<std::string>& keys) {
    for (const std::string& key : keys) {
      if (misspelt_[pointer].count(key) != 0) continue;
      const SchemaViews views = child_views(schema_, places_.at(pointer).views, key, nullptr);
      const std::string description = keyword_text(views, "description");
      std::string cure = example_cure(views, "");
      if (cure.rfind("write for example ", 0) == 0) {
        cure = "add for example \"" + key + "\": " + cure.substr(18);
      } else {
        cure = "add \"" + key + "\"" + (description.empty() ? "" : ": " + description);
      }
      problems_.push_back(
          {pointer, document_.line_of(pointer), "\"" + key + "\" is missing", cure});
      reported_.insert(pointer);
    }
  }

  const JsonDocument& document_;
  const json& schema_;
  std::unordered_map<std::string, Place> places_;
  std::map<std::string, std::set<std::string>> missing_;
  std::map<std::string, std::set<std::string>> misspelt_;
  std::vector<std::string> wrappers_;
  std::unordered_set<std::string> keys_explained_;
  std::set<std::string> reported_;
  std::vector<Problem> problems_;
};

}  // namespace

namespace {

/// Texts and keys that a terminal would obey, except comments, which go nowhere.
void check_characters(const JsonDocument& document, const json& value, const std::string& pointer,
                      std::vector<Problem>& problems) {
  const auto refuse = [&](const char* what, const std::string& place, const std::string& bad) {
    problems.push_back({place, document.line_of(place),
                        concat(what, " holds the control character or stray byte ", bad),
                        "remove it"});
  };
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    if (const std::string bad = first_unprintable(text); !bad.empty()) {
      refuse("the text", pointer, bad);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!value[i].is_string() && !value[i].is_structured()) continue;
      check_characters(document, value[i], pointer + "/" + std::to_string(i), problems);
    }
  } else if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      if (key == "comment") continue;
      const std::string place = pointer + "/" + pointer_token(key);
      const std::string bad = first_unprintable(key);
      if (!bad.empty()) refuse("the key", place, bad);
      check_characters(document, inner, place, problems);
    }
  }
}

/// Lists that must not repeat themselves, where valijson would compare all pairs.
void check_unique_items(const JsonDocument& document, const json& schema,
                        std::vector<Problem>& problems) {
  walk_schema(
      schema, document.value,
      [&](const std::string& pointer, const json& value, const SchemaViews& views) {
        const json* unique = keyword(views, "uniqueItems");
        if (unique == nullptr || !value.is_array()) return;
        std::unordered_set<std::string> seen;
        for (const json& one : value) {
          if (seen.insert(one.dump(-1, ' ', false, json::error_handler_t::replace)).second)
            continue;
          problems.push_back({pointer, document.line_of(pointer),
                              as_text(value) + " has equal elements", "remove one of them"});
          return;
        }
      });
}

}  // namespace

std::vector<Problem> check_schema(const JsonDocument& document, const json& schema) {
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter target(document.value);
  const bool in_pairs = !has_long_array(document.value);
  const bool valid = validator.validate(compiled(schema, in_pairs), target, &results);
  std::vector<Problem> problems;
  if (!valid) {
    Explainer explainer(document, schema);
    for (const auto& error : results) {
      explainer.explain(pointer_of(error.context), error.description);
    }
    problems = explainer.finish();
    FAULTSIM_DEMAND(!problems.empty(), "invalid without a reason: ", document.source);
  }
  if (!in_pairs) check_unique_items(document, schema, problems);
  check_characters(document, document.value, "", problems);
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return a.line != b.line ? a.line < b.line : a.pointer < b.pointer;
  });
  return problems;
}

}  // namespace faultsim
