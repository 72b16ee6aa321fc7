#include "simulator/documents/schema.h"

#include <algorithm>
#include <set>

#include "simulator/common/errors.h"
#include "simulator/common/printable.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr unsigned bit(json::value_t type) { return 1U << static_cast<unsigned>(type); }

unsigned types_named(const json& names) {
  if (names.is_array()) {
    unsigned types = 0;
    for (const json& name : names) types |= types_named(name);
    return types;
  }
  using Type = json::value_t;
  constexpr unsigned kWhole = bit(Type::number_integer) | bit(Type::number_unsigned);
  static const std::map<std::string, unsigned> known = {
      {"object", bit(Type::object)},
      {"array", bit(Type::array)},
      {"string", bit(Type::string)},
      {"boolean", bit(Type::boolean)},
      {"null", bit(Type::null)},
      {"integer", kWhole},
      {"number", kWhole | bit(Type::number_float)}};
  return known.at(names.get<std::string>());
}

/// Enough for the conditions of `if`: type, const, enum, required, properties.
bool accepts(const SchemaRules& condition, const json& value) {
  if ((condition.types & bit(value.type())) == 0) return false;
  if (condition.only != nullptr && *condition.only != value) return false;
  if (condition.allowed != nullptr &&
      std::ranges::find(*condition.allowed, value) == condition.allowed->end()) {
    return false;
  }
  if (!value.is_object()) return true;
  for (const std::string& key : condition.required) {
    if (!value.contains(key)) return false;
  }
  for (const auto& [key, inner] : condition.properties) {
    if (const auto at = value.find(key); at != value.end() && !accepts(*inner, *at)) return false;
  }
  return true;
}

bool has_branches(const SchemaRules& rules) {
  return rules.condition != nullptr ||
         std::ranges::any_of(rules.parts,
                             [](const SchemaRules* part) { return has_branches(*part); });
}

void expand(const SchemaRules& rules, const json& value, SchemaViews& views) {
  views.push_back(&rules);
  for (const SchemaRules* part : rules.parts) expand(*part, value, views);
  if (rules.condition == nullptr) return;
  const SchemaRules* branch = accepts(*rules.condition, value) ? rules.then : rules.otherwise;
  if (branch != nullptr) expand(*branch, value, views);
}

const SchemaRules* member_rules(const SchemaRules& rules, const std::string& key) {
  const auto found = rules.properties.find(key);
  return found == rules.properties.end() ? rules.additional : found->second;
}

/// @param child  of one view: its rules for the child, or nullptr.
template <typename Child>
const SchemaViews& views_of_child(const SchemaViews& parent, const json& value,
                                  SchemaViews& scratch, const Child& child) {
  const SchemaRules* only = nullptr;
  scratch.clear();
  for (const SchemaRules* view : parent) {
    const SchemaRules* rules = child(*view);
    if (rules == nullptr) continue;
    if (only == nullptr && scratch.empty() && !rules->views.empty()) {
      only = rules;
      continue;
    }
    if (only != nullptr) scratch = only->views;
    only = nullptr;
    expand(*rules, value, scratch);
  }
  return only != nullptr ? only->views : scratch;
}

}  // namespace

Schema::Schema(json text) : text_(std::move(text)) {
  root_ = rules_of(text_);
  for (SchemaRules& rules : all_) {
    if (!has_branches(rules)) expand(rules, nullptr, rules.views);
  }
}

const SchemaRules* Schema::rules_of(const json& part) {
  const auto [place, is_new] = by_part_.emplace(&part, nullptr);
  if (!is_new) return place->second;
  SchemaRules* rules = place->second = &all_.emplace_back();
  rules->text = &part;
  if (part.contains("$ref")) {
    const json::json_pointer target(part["$ref"].get<std::string>().substr(1));
    rules->parts = {rules_of(text_.at(target))};
    return rules;
  }
  for (const auto& [name, value] : part.items()) read_keyword(name, value, *rules);
  return rules;
}

void Schema::read_keyword(const std::string& name, const json& value, SchemaRules& rules) {
  using Rules = SchemaRules;
  static const std::map<std::string, double Rules::*> numbers = {
      {"minimum", &Rules::least}, {"maximum", &Rules::most}, {"exclusiveMinimum", &Rules::above}};
  static const std::map<std::string, std::size_t Rules::*> counts = {
      {"minLength", &Rules::min_length},      {"maxLength", &Rules::max_length},
      {"minItems", &Rules::min_items},        {"maxItems", &Rules::max_items},
      {"minProperties", &Rules::min_entries}, {"maxProperties", &Rules::max_entries}};
  static const std::map<std::string, const Rules* Rules::*> parts = {{"items", &Rules::items},
                                                                     {"if", &Rules::condition},
                                                                     {"then", &Rules::then},
                                                                     {"else", &Rules::otherwise}};
  static const std::set<std::string> annotations = {
      "$schema", "$comment", "title", "description", "default", "examples", "definitions"};
  if (const auto number = numbers.find(name); number != numbers.end()) {
    rules.*number->second = value.get<double>();
  } else if (const auto count = counts.find(name); count != counts.end()) {
    rules.*count->second = value.get<std::size_t>();
  } else if (const auto part = parts.find(name); part != parts.end()) {
    rules.*part->second = rules_of(value);
  } else if (name == "type") {
    rules.types = types_named(value);
  } else if (name == "const") {
    rules.only = &value;
  } else if (name == "enum") {
    rules.allowed = &value;
  } else if (name == "uniqueItems") {
    rules.unique_items = value.get<bool>();
  } else if (name == "required") {
    rules.required = value.get<std::vector<std::string>>();
  } else if (name == "properties") {
    for (const auto& [key, inner] : value.items()) rules.properties[key] = rules_of(inner);
  } else if (name == "additionalProperties" && value.is_boolean()) {
    rules.closed = !value.get<bool>();
  } else if (name == "additionalProperties") {
    rules.additional = rules_of(value);
  } else if (name == "allOf") {
    for (const json& one : value) rules.parts.push_back(rules_of(one));
  } else {
    FAULTSIM_DEMAND(annotations.count(name) != 0 || name.rfind("x-", 0) == 0, "keyword ", name);
  }
}

SchemaViews schema_views(const SchemaRules& rules, const json& value) {
  SchemaViews views;
  expand(rules, value, views);
  return views;
}

const SchemaViews& member_views(const SchemaViews& parent, const std::string& key,
                                const json& value, SchemaViews& scratch) {
  return views_of_child(parent, value, scratch,
                        [&](const SchemaRules& view) { return member_rules(view, key); });
}

const SchemaViews& item_views(const SchemaViews& parent, const json& value, SchemaViews& scratch) {
  return views_of_child(parent, value, scratch,
                        [&](const SchemaRules& view) { return view.items; });
}

bool accepts_alone(const SchemaViews& views, const json& value) {
  return std::ranges::all_of(views, [&](const SchemaRules* view) {
    if ((view->types & bit(value.type())) == 0) return false;
    if (!value.is_number()) return true;
    const auto number = value.get<double>();
    return number >= view->least && number <= view->most && number > view->above;
  });
}

const json* keyword(const SchemaViews& views, const char* name) {
  for (const SchemaRules* view : views) {
    if (const auto found = view->text->find(name); found != view->text->end()) return &*found;
  }
  return nullptr;
}

std::string keyword_text(const SchemaViews& views, const char* name) {
  const json* found = keyword(views, name);
  if (found == nullptr) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

std::vector<std::string> known_keys(const SchemaViews& views) {
  std::set<std::string> names;
  for (const SchemaRules* view : views) {
    for (const auto& [key, inner] : view->properties) names.insert(key);
  }
  names.erase("comment");
  return {names.begin(), names.end()};
}

std::vector<std::string> enum_texts(const SchemaViews& views) {
  std::vector<std::string> texts;
  if (const json* allowed = keyword(views, "enum")) {
    for (const json& value : *allowed) {
      texts.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return texts;
}

void Ancestry::add(std::string pointer) {
  while (places_.insert(pointer).second && !pointer.empty()) {
    const std::size_t slash = pointer.rfind('/');
    pointer.resize(slash == std::string::npos ? 0 : slash);
  }
}

std::string as_text(const json& value) {
  constexpr std::size_t kLongest = 40;
  return shortened(value.dump(-1, ' ', false, json::error_handler_t::replace), kLongest);
}

}  // namespace faultsim
