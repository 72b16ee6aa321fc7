#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "simulator/common/fingerprint.h"
#include "simulator/scene/json_document.h"
#include "simulator/scene/near_miss.h"
#include "simulator/scene/schema_walk.h"

/// valijson says which values are wrong; this file says it in words a user can act on, from the
/// same schema. One problem per mistake: valijson also reports every parent of a wrong value.
namespace faultsim {
namespace {

using nlohmann::json;

/// Schemas as valijson wants them, made once per process and text.
const valijson::Schema& compiled(const json& schema) {
  static std::mutex mutex;
  static std::map<std::string, std::unique_ptr<valijson::Schema>> cache;
  const std::lock_guard lock(mutex);
  auto& entry = cache[fingerprint(schema.dump())];
  if (!entry) {
    entry = std::make_unique<valijson::Schema>();
    valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
    parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema), *entry);
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

std::map<std::string, Place> places_of(const JsonDocument& document, const json& schema) {
  std::map<std::string, Place> places;
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
          example_cure(views, suggest(word, allowed)));
    } else if (says("Expected number")) {
      add(pointer, as_text(value) + " is " + range_words(views),
          example_cure(views, "write a number in the range"));
    } else if (says("Array should contain")) {
      const json* wanted = keyword(views, says("no more") ? "maxItems" : "minItems");
      add(pointer, concat("has ", value.size(), " elements"),
          concat("write ", says("no more") ? "at most " : "at least ", *wanted));
    } else if (description.rfind("Failed to validate", 0) == 0) {
      wrappers_.emplace_back(pointer, description);
    } else if (says("no fewer than")) {
      add(pointer, as_text(value) + " is too short", example_cure(views, "fill it in"));
    } else if (says("Elements at indexes")) {
      add(pointer, as_text(value) + " has equal elements", "remove one of them");
    } else {
      add(pointer, as_text(value) + ": " + description, "see the schema");
    }
  }

  std::vector<Problem> finish() {
    for (const auto& [pointer, keys] : missing_) explain_missing(pointer, keys);
    for (const auto& [pointer, description] : wrappers_) {
      const std::string below = pointer + "/";
      const auto is_reason = [&](const Problem& problem) {
        return problem.pointer == pointer || problem.pointer.rfind(below, 0) == 0;
      };
      if (std::none_of(problems_.begin(), problems_.end(), is_reason)) {
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

  void explain_unknown_keys(const std::string& pointer, const Place& place) {
    const std::vector<std::string> known = known_keys(place.views);
    for (const auto& [key, inner] : place.value->items()) {
      if (key == "comment" || std::binary_search(known.begin(), known.end(), key)) continue;
      std::vector<std::string> free;
      for (const std::string& name : known) {
        if (!place.value->contains(name)) free.push_back(name);
      }
      misspelt_[pointer].insert(near_miss(key, free));
      add(pointer + "/" + pointer_token(key), "\"" + key + "\" is not a key of this object",
          suggest(key, free));
    }
  }

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
  std::map<std::string, Place> places_;
  std::map<std::string, std::set<std::string>> missing_;
  std::map<std::string, std::set<std::string>> misspelt_;
  std::vector<std::pair<std::string, std::string>> wrappers_;
  std::set<std::string> reported_;
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Problem> check_schema(const JsonDocument& document, const json& schema) {
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults results;
  const valijson::adapters::NlohmannJsonAdapter target(document.value);
  if (validator.validate(compiled(schema), target, &results)) return {};
  Explainer explainer(document, schema);
  for (const auto& error : results) explainer.explain(pointer_of(error.context), error.description);
  std::vector<Problem> problems = explainer.finish();
  FAULTSIM_DEMAND(!problems.empty(), "invalid without a reason: ", document.source);
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return a.line != b.line ? a.line < b.line : a.pointer < b.pointer;
  });
  return problems;
}

}  // namespace faultsim
