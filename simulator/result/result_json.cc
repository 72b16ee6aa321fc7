#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "simulator/common/errors.h"
#include "simulator/result/result_fields.h"
#include "simulator/result/result_json.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr int kResultFormat = 2;

json to_json(const Field& field, double value) {
  FAULTSIM_DEMAND(!std::isinf(value), field.key, " is infinite");
  return std::isnan(value) ? json() : json(value);
}
json to_json(const Field&, bool value) { return value; }
json to_json(const Field&, int value) { return value; }
json to_json(const Field&, const std::string& value) { return value; }
json to_json(const Field&, Outcome value) { return to_string(value); }
template <typename Struct>
requires std::is_class_v<Struct> json to_json(const Field&, const Struct& value);
template <typename Value>
json to_json(const Field& field, const std::optional<Value>& value) {
  return value ? to_json(field, *value) : json();
}
template <typename Value>
json to_json(const Field& field, const std::vector<Value>& values) {
  json list = json::array();
  for (const Value& value : values) list.push_back(to_json(field, value));
  return list;
}
template <typename Struct>
requires std::is_class_v<Struct> json to_json(const Field&, const Struct& value) {
  json object = json::object();
  for_each_field(value, [&object](const Field& field, const auto& member) {
    object[std::string(field.key)] = to_json(field, member);
  });
  return object;
}

[[noreturn]] void refuse(std::string_view name, const json& value, const char* wanted) {
  throw StorageError(concat("\"", name, "\" is ", value.type_name(), " instead of ", wanted));
}
void read(std::string_view name, const json& value, double& target) {
  if (!value.is_null() && !value.is_number()) refuse(name, value, "a number");
  target = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}
void read(std::string_view name, const json& value, bool& target) {
  if (!value.is_boolean()) refuse(name, value, "true or false");
  target = value.get<bool>();
}
void read(std::string_view name, const json& value, int& target) {
  if (!value.is_number_integer()) refuse(name, value, "an integer");
  const auto number = value.get<std::int64_t>();
  if (!std::in_range<int>(number)) throw StorageError(concat("\"", name, "\" is too large"));
  target = static_cast<int>(number);
}
void read(std::string_view name, const json& value, std::string& target) {
  if (!value.is_string()) refuse(name, value, "text");
  target = value.get<std::string>();
}
void read(std::string_view name, const json& value, Outcome& target) {
  std::string text;
  read(name, value, text);
  target = stored_word<Outcome>(text, "outcome");
}
template <typename Struct>
requires std::is_class_v<Struct>
void read(std::string_view name, const json& value, Struct& target);
template <typename Value>
void read(std::string_view name, const json& value, std::optional<Value>& target) {
  target.reset();
  if (!value.is_null()) read(name, value, target.emplace());
}
template <typename Value>
void read(std::string_view name, const json& value, std::vector<Value>& target) {
  if (!value.is_array()) refuse(name, value, "an array");
  target.clear();
  for (std::size_t i = 0; i < value.size(); ++i) {
    with_context([&] { return concat("reading ", name, "/", i); },
                 [&] { read(name, value[i], target.emplace_back()); });
  }
}
template <typename Struct>
requires std::is_class_v<Struct>
void read(std::string_view name, const json& value, Struct& target) {
  if (!value.is_object()) refuse(name, value, "an object");
  for_each_field(target, [&value](const Field& field, auto& member) {
    const auto found = value.find(std::string(field.key));
    if (found != value.end()) {
      read(field.key, *found, member);
    } else if (field.since == 0) {
      throw StorageError(concat("the key \"", field.key, "\" is missing"));
    }
  });
}

}  // namespace

nlohmann::json result_to_json(const CaseResult& result) {
  json document = to_json(Field{}, result);
  document["format"] = kResultFormat;
  return document;
}

CaseResult result_from_json(const nlohmann::json& document) {
  return with_context([] { return "reading a result"; },
                      [&] {
                        if (!document.is_object()) throw StorageError("it is not a JSON object");
                        const auto format = document.find("format");
                        if (format == document.end())
                          throw StorageError("the key \"format\" is missing");
                        if (*format != kResultFormat) {
                          throw StorageError(concat("it has format version ", format->dump(),
                                                    "; this program reads ", kResultFormat));
                        }
                        CaseResult result;
                        read("result", document, result);
                        return result;
                      });
}

}  // namespace faultsim
