#include "simulator/scene/schema_walk.h"

#include <algorithm>
#include <set>

#include "simulator/common/printable.h"

namespace faultsim {
namespace {

using nlohmann::json;

bool has_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == "null" && value.is_null();
}

/// Enough of draft-07 for the conditions of `if`: type, const, enum, required, properties.
bool accepts(const json& condition, const json& value) {
  if (condition.contains("type") && !has_type(value, condition["type"])) return false;
  if (condition.contains("const") && condition["const"] != value) return false;
  if (condition.contains("enum")) {
    const json& allowed = condition["enum"];
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) return false;
  }
  if (!value.is_object()) return true;
  if (condition.contains("required")) {
    for (const auto& key : condition["required"]) {
      if (!value.contains(key.get<std::string>())) return false;
    }
  }
  if (condition.contains("properties")) {
    for (const auto& [key, inner] : condition["properties"].items()) {
      if (value.contains(key) && !accepts(inner, value[key])) return false;
    }
  }
  return true;
}

void expand(const json& root, const json& schema, const json& value, SchemaViews& views) {
  views.push_back(&schema);
  if (schema.contains("$ref")) {
    const auto text = schema["$ref"].get<std::string>();
    expand(root, root.at(json::json_pointer(text.substr(1))), value, views);
  }
  if (schema.contains("allOf")) {
    for (const auto& part : schema["allOf"]) expand(root, part, value, views);
  }
  if (schema.contains("if")) {
    const char* branch = accepts(schema["if"], value) ? "then" : "else";
    if (schema.contains(branch)) expand(root, schema[branch], value, views);
  }
}

void walk(const json& root, const json& value, const SchemaViews& views, const std::string& pointer,
          const SchemaVisitor& visit) {
  visit(pointer, value, views);
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      walk(root, inner, child_views(root, views, key, inner), pointer + "/" + pointer_token(key),
           visit);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string key = std::to_string(i);
      walk(root, value[i], child_views(root, views, key, value[i]), pointer + "/" + key, visit);
    }
  }
}

}  // namespace

SchemaViews schema_views(const json& root, const json& schema, const json& value) {
  SchemaViews views;
  if (schema.is_object()) expand(root, schema, value, views);
  return views;
}

SchemaViews child_views(const json& root, const SchemaViews& parent, const std::string& key,
                        const json& value) {
  SchemaViews result;
  const auto add = [&](const json& schema) {
    const SchemaViews more = schema_views(root, schema, value);
    result.insert(result.end(), more.begin(), more.end());
  };
  for (const json* view : parent) {
    if (view->contains("properties") && (*view)["properties"].contains(key)) {
      add((*view)["properties"][key]);
    }
  }
  if (!result.empty()) return result;
  for (const json* view : parent) {
    for (const char* name : {"additionalProperties", "items"}) {
      if (view->contains(name) && (*view)[name].is_object()) add((*view)[name]);
    }
  }
  return result;
}

const json* keyword(const SchemaViews& views, const char* name) {
  for (const json* view : views) {
    if (view->contains(name)) return &(*view)[name];
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
  for (const json* view : views) {
    if (!view->contains("properties")) continue;
    for (const auto& [key, inner] : (*view)["properties"].items()) names.insert(key);
  }
  names.erase("comment");
  return {names.begin(), names.end()};
}

std::vector<std::string> enum_texts(const SchemaViews& views) {
  std::vector<std::string> texts;
  if (const json* allowed = keyword(views, "enum")) {
    for (const auto& value : *allowed) {
      texts.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return texts;
}

void walk_schema(const json& root, const json& value, const SchemaVisitor& visit) {
  walk(root, value, schema_views(root, root, value), "", visit);
}

void Ancestry::add(std::string pointer) {
  while (places_.insert(pointer).second && !pointer.empty()) {
    const std::size_t slash = pointer.rfind('/');
    pointer.resize(slash == std::string::npos ? 0 : slash);
  }
}

std::string pointer_token(const std::string& key) {
  std::string token;
  for (const char letter : key) {
    if (letter == '~') {
      token += "~0";
    } else if (letter == '/') {
      token += "~1";
    } else {
      token += letter;
    }
  }
  return token;
}

std::string as_text(const json& value) {
  constexpr std::size_t kLongest = 40;
  return shortened(value.dump(-1, ' ', false, json::error_handler_t::replace), kLongest);
}

}  // namespace faultsim
