#include "campaign/report/parameters.h"

#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"

namespace faultsweep {

using nlohmann::json;

std::string parameters_to_json(const std::vector<StoredParameter>& parameters) {
  json all = json::array();
  for (const StoredParameter& one : parameters) {
    all.push_back({{"name", one.name},
                   {"dimension", one.is_text ? "text" : faultsim::info_of(one.dimension).key}});
  }
  return all.dump();
}

std::vector<StoredParameter> parameters_from_json(const std::string& text) {
  std::vector<StoredParameter> parameters;
  try {
    for (const json& one : json::parse(text)) {
      const std::string dimension = one.at("dimension");
      StoredParameter parameter;
      parameter.name = one.at("name");
      parameter.is_text = dimension == "text";
      const auto* known = faultsim::dimension_named(dimension);
      if (!parameter.is_text && known == nullptr) {
        throw faultsim::StorageError("unknown dimension '" + dimension +
                                     "' in the store's parameters");
      }
      if (!parameter.is_text) parameter.dimension = known->dimension;
      parameters.push_back(std::move(parameter));
    }
  } catch (const json::exception& error) {
    throw faultsim::StorageError(
        faultsim::concat("the store's parameters cannot be read: ", error.what()));
  }
  return parameters;
}

namespace {

const StoredParameter& of(const CaseParameter& value,
                          const std::vector<StoredParameter>& parameters) {
  const auto index = static_cast<std::size_t>(value.index);
  if (index < parameters.size()) return parameters[index];
  throw faultsim::StorageError(faultsim::concat("a case of the store has a parameter number ",
                                                value.index, ", which its campaign has not"));
}

}  // namespace

std::vector<std::string> labels_of(const CaseParameters& values,
                                   const std::vector<StoredParameter>& parameters) {
  std::vector<std::string> labels(parameters.size());
  for (const CaseParameter& one : values)
    labels[&of(one, parameters) - parameters.data()] = one.text;
  return labels;
}

std::vector<std::string> settings_of(const CaseParameters& values,
                                     const std::vector<StoredParameter>& parameters) {
  std::vector<std::string> settings;
  for (const CaseParameter& one : values) {
    if (!one.text.empty()) settings.push_back(of(one, parameters).name + " = " + one.text);
  }
  return settings;
}

nlohmann::json value_to_json(const CaseParameter& value) {
  return value.si ? json(*value.si) : json(value.text);
}

nlohmann::json values_to_json(const CaseParameters& values,
                              const std::vector<StoredParameter>& parameters) {
  json named = json::object();
  for (const CaseParameter& one : values) {
    const StoredParameter& parameter = of(one, parameters);
    named[parameter.name] = {
        {"value", value_to_json(one)},
        {"unit", parameter.is_text ? "" : faultsim::si_unit(parameter.dimension)},
        {"text", one.text}};
  }
  return named;
}

}  // namespace faultsweep
