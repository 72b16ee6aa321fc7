#include "campaign/report/parameters.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::Dimension;
using nlohmann::json;

namespace {

constexpr std::array<std::pair<Dimension, const char*>, 11> kDimensions = {{
    {Dimension::number, "number"},
    {Dimension::length, "length"},
    {Dimension::area, "area"},
    {Dimension::pressure, "pressure"},
    {Dimension::pressure_gradient, "pressure_gradient"},
    {Dimension::density, "density"},
    {Dimension::angle, "angle"},
    {Dimension::time, "time"},
    {Dimension::viscosity, "viscosity"},
    {Dimension::moment, "moment"},
    {Dimension::potency, "potency"},
}};

}  // namespace

std::string dimension_name(Dimension dimension) {
  for (const auto& [one, name] : kDimensions) {
    if (one == dimension) return name;
  }
  FAULTSIM_DEMAND(false, static_cast<int>(dimension));
  return "";
}

Dimension dimension_named(const std::string& text) {
  for (const auto& [one, name] : kDimensions) {
    if (text == name) return one;
  }
  throw faultsim::StorageError(
      faultsim::concat("unknown dimension '", text, "' in the store's parameters"));
}

std::string parameters_to_json(const std::vector<StoredParameter>& parameters) {
  json all = json::array();
  for (const StoredParameter& one : parameters) {
    all.push_back(
        {{"name", one.name}, {"dimension", one.is_text ? "text" : dimension_name(one.dimension)}});
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
      if (!parameter.is_text) parameter.dimension = dimension_named(dimension);
      parameters.push_back(std::move(parameter));
    }
  } catch (const json::exception& error) {
    throw faultsim::StorageError(
        faultsim::concat("the store's parameters cannot be read: ", error.what()));
  }
  return parameters;
}

std::vector<std::string> labels_from_json(const std::string& text) {
  std::vector<std::string> labels;
  const json all = json::parse(text, nullptr, false);
  if (!all.is_array()) return labels;
  for (const json& one : all) labels.push_back(one.is_string() ? one.get<std::string>() : "");
  return labels;
}

}  // namespace faultsweep
