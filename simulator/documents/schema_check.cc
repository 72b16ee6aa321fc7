#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "simulator/common/near_miss.h"
#include "simulator/common/printable.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/documents/schema.h"

/// What a value breaks, in words that a user can act on.
namespace faultsim {
namespace {

using nlohmann::json;

std::string type_words(const json& types) {
  static const std::map<std::string, std::string> words = {{"object", "an object {...}"},
                                                           {"array", "a list [...]"},
                                                           {"string", "text"},
                                                           {"number", "a number"},
                                                           {"integer", "a whole number"},
                                                           {"boolean", "true or false"},
                                                           {"null", "null"}};
  if (types.is_string()) return words.at(types.get<std::string>());
  return joined(types, " or ", type_words);
}

std::string range_words(const SchemaViews& views) {
  const json* least = keyword(views, "minimum");
  const json* most = keyword(views, "maximum");
  if (least != nullptr && most != nullptr) {
    return "outside [" + least->dump() + ", " + most->dump() + "]";
  }
  if (least != nullptr) return "below " + least->dump();
  const json* above = keyword(views, "exclusiveMinimum");
  return above != nullptr ? "not above " + above->dump()
                          : "above " + keyword_text(views, "maximum");
}

/// "write <example>" where the schema has one.
std::string example_cure(const SchemaViews& views, const std::string& otherwise) {
  if (const std::string cure = keyword_text(views, "x-cure"); !cure.empty()) return cure;
  if (const json* examples = keyword(views, "examples")) {
    return "write for example " + examples->at(0).dump();
  }
  return otherwise;
}

std::size_t count_characters(const std::string& text) {
  return std::ranges::count_if(text, [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;  // not the rest of one, in UTF-8
  });
}

/// Sorted instead of compared in pairs: a list may have 10^5 elements.
bool has_equal_elements(const json& list) {
  std::vector sorted = mapped(list, [&](const json& one) { return &one; });
  const auto less = [](const json* a, const json* b) { return *a < *b; };
  std::ranges::sort(sorted, less);
  return std::ranges::adjacent_find(
             sorted, [](const json* a, const json* b) { return *a == *b; }) != sorted.end();
}

class SchemaChecker {
 public:
  SchemaChecker(const JsonDocument& document, const SchemaVisitor& visit)
      : document_(document), visit_(visit) {}

  void walk(const ValuePlace& place, const json& value, const SchemaViews& views) {
    if (views.empty()) return;
    for (const SchemaRules* view : views) check(place, value, *view, views);
    SchemaViews scratch;
    if (value.is_object()) {
      check_keys(place, value, views);
      for (auto member = value.begin(); member != value.end(); ++member) {
        walk({&place, &member.key()}, *member, member_views(views, member.key(), *member, scratch));
      }
    } else if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        walk({&place, nullptr, i}, value[i], item_views(views, value[i], scratch));
      }
    }
    if (visit_) visit_(place, value, views);
  }

  /// Texts and keys that a terminal would obey, except comments, which go nowhere.
  void check_characters(const ValuePlace& place, const json& value) {
    const auto refuse = [&](const char* what, const ValuePlace& at, const std::string& bad) {
      const std::string pointer = at.pointer();
      problems_.push_back({pointer, document_.line_of(pointer),
                           concat(what, " contains the control character or stray byte ", bad),
                           "remove it"});
    };
    if (value.is_string()) {
      const std::string bad = first_unprintable(value.get_ref<const std::string&>());
      if (!bad.empty()) refuse("the text", place, bad);
    } else if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        check_characters({&place, nullptr, i}, value[i]);
      }
    } else if (value.is_object()) {
      for (auto member = value.begin(); member != value.end(); ++member) {
        if (member.key() == "comment") continue;
        const ValuePlace inner{&place, &member.key()};
        const std::string bad = first_unprintable(member.key());
        if (!bad.empty()) refuse("the key", inner, bad);
        check_characters(inner, *member);
      }
    }
  }

  std::vector<Problem> problems() && {
    std::ranges::stable_sort(problems_, [](const Problem& a, const Problem& b) {
      return a.line != b.line ? a.line < b.line : a.pointer < b.pointer;
    });
    return std::move(problems_);
  }

 private:
  /// One problem per place, the first.
  void add(const std::string& pointer, const std::string& what, const std::string& cure) {
    if (!reported_.insert(pointer).second) return;
    problems_.push_back({pointer, document_.line_of(pointer), what, cure});
  }
  /// After so many problems nobody reads near misses, and looking for them takes time.
  bool may_suggest() const { return problems_.size() < kMostSuggestions; }

  /// Nothing of what stands below the value.
  void check(const ValuePlace& place, const json& value, const SchemaRules& rules,
             const SchemaViews& views) {
    const bool known = (rules.only == nullptr || *rules.only == value) &&
                       (rules.allowed == nullptr ||
                        std::ranges::find(*rules.allowed, value) != rules.allowed->end());
    if (!known) explain_word(place, value, views);
    if (value.is_number()) {
      const auto number = value.get<double>();
      const bool inside = number >= rules.least && number <= rules.most && number > rules.above;
      if (!inside) {
        add(place.pointer(), as_text(value) + " is " + range_words(views),
            example_cure(views, "write a number in the range"));
      }
    } else if (value.is_string()) {
      check_text(place, value, rules, views);
    } else if (value.is_array()) {
      check_list(place, value, rules);
    } else if (value.is_object()) {
      if (value.size() > rules.max_entries) {
        add(place.pointer(), concat("has ", value.size(), " entries"),
            concat("write at most ", rules.max_entries));
      }
      if (value.size() < rules.min_entries) {
        add(place.pointer(), as_text(value) + " is too short", example_cure(views, "fill it in"));
      }
    }
    if ((rules.types & 1U << static_cast<unsigned>(value.type())) == 0) {
      explain_type(place, value, views);
    }
  }

  void explain_word(const ValuePlace& place, const json& value, const SchemaViews& views) {
    std::vector<std::string> allowed = enum_texts(views);
    if (const json* only = keyword(views, "const")) allowed = {only->dump()};
    const std::string word = value.is_string() ? value.get<std::string>() : "";
    add(place.pointer(), as_text(value) + " is not known here",
        example_cure(views, may_suggest() ? suggest(word, allowed) : "write a known word"));
  }

  void explain_type(const ValuePlace& place, const json& value, const SchemaViews& views) {
    const json* types = keyword(views, "type");
    const bool quantity = keyword(views, "x-dimension") != nullptr;
    const std::string wanted = quantity ? "a number with a unit, as text" : type_words(*types);
    add(place.pointer(), as_text(value) + " is not " + wanted,
        example_cure(views, "write " + wanted));
  }

  void check_text(const ValuePlace& place, const json& value, const SchemaRules& rules,
                  const SchemaViews& views) {
    if (rules.min_length == 0 && rules.max_length == ~std::size_t{0}) return;
    const std::size_t length = count_characters(value.get_ref<const std::string&>());
    if (length > rules.max_length) {
      add(place.pointer(), as_text(value) + " is too long",
          concat("write at most ", rules.max_length, " characters"));
    } else if (length < rules.min_length) {
      add(place.pointer(), as_text(value) + " is too short", example_cure(views, "fill it in"));
    }
  }

  void check_list(const ValuePlace& place, const json& value, const SchemaRules& rules) {
    const bool few = value.size() < rules.min_items;
    if (few || value.size() > rules.max_items) {
      add(place.pointer(), concat("has ", value.size(), " elements"),
          few ? concat("write at least ", rules.min_items)
              : concat("write at most ", rules.max_items));
    }
    if (rules.unique_items && has_equal_elements(value)) {
      add(place.pointer(), as_text(value) + " has duplicate elements", "remove one of them");
    }
  }

  /// Keys that are missing and keys that should not be there. One that is there but misspelt is one
  /// mistake, reported where it stands.
  void check_keys(const ValuePlace& place, const json& value, const SchemaViews& views) {
    std::set<std::string> unknown;
    std::set<std::string> missing;
    for (const SchemaRules* view : views) {
      for (const std::string& key : view->required) {
        if (!value.contains(key)) missing.insert(key);
      }
      if (!view->closed) continue;
      for (auto member = value.begin(); member != value.end(); ++member) {
        if (view->properties.find(member.key()) == view->properties.end()) {
          unknown.insert(member.key());
        }
      }
    }
    if (unknown.empty() && missing.empty()) return;
    const std::string pointer = place.pointer();
    std::vector<std::string> free;
    for (const std::string& name : known_keys(views)) {
      if (!value.contains(name)) free.push_back(name);
    }
    std::set<std::string> misspelt;
    for (const std::string& key : unknown) {
      if (may_suggest()) misspelt.insert(near_miss(key, free));
      add(pointer + "/" + pointer_token(key), "\"" + key + "\" is not a key of this object",
          may_suggest() ? suggest(key, free) : "remove it");
    }
    for (const std::string& key : missing) {
      if (misspelt.count(key) == 0) explain_missing(pointer, key, views);
    }
  }

  void explain_missing(const std::string& pointer, const std::string& key,
                       const SchemaViews& parent) {
    SchemaViews scratch;
    const SchemaViews& views = member_views(parent, key, nullptr, scratch);
    const std::string description = keyword_text(views, "description");
    std::string cure = example_cure(views, "");
    if (cure.rfind("write for example ", 0) == 0) {
      cure = "add for example \"" + key + "\": " + cure.substr(18);
    } else {
      cure = "add \"" + key + "\"" + (description.empty() ? "" : ": " + description);
    }
    problems_.push_back({pointer, document_.line_of(pointer), "\"" + key + "\" is missing", cure});
    reported_.insert(pointer);
  }

  const JsonDocument& document_;
  const SchemaVisitor& visit_;
  std::set<std::string> reported_;
  std::vector<Problem> problems_;
};

}  // namespace

std::string ValuePlace::pointer() const {
  if (parent == nullptr) return "";
  return parent->pointer() + "/" + (key == nullptr ? std::to_string(index) : pointer_token(*key));
}

std::vector<Problem> check_schema(const JsonDocument& document, const Schema& schema,
                                  const SchemaVisitor& visit) {
  SchemaChecker checker(document, visit);
  checker.walk({}, document.value, schema_views(schema.root(), document.value));
  checker.check_characters({}, document.value);
  return std::move(checker).problems();
}

std::vector<Problem> check_members(const JsonDocument& document, const Schema& schema,
                                   std::span<const std::string> members,
                                   const SchemaVisitor& visit) {
  SchemaChecker checker(document, visit);
  const SchemaViews views = schema_views(schema.root(), document.value);
  const ValuePlace top;
  SchemaViews scratch;
  for (const std::string& name : members) {
    const auto member = document.value.find(name);
    if (member == document.value.end()) continue;
    const ValuePlace place{&top, &name};
    checker.walk(place, *member, member_views(views, name, *member, scratch));
    checker.check_characters(place, *member);
  }
  return std::move(checker).problems();
}

}  // namespace faultsim
