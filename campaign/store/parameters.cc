#include "campaign/common/json.h"
#include "campaign/store/records.h"

namespace faultsweep {

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
      if (dimension == "text") {
        parameters.push_back({.name = one.at("name"), .is_text = true});
      } else if (const auto* known = faultsim::dimension_named(dimension)) {
        parameters.push_back({.name = one.at("name"), .dimension = known->dimension});
      } else {
        throw StorageError("unknown dimension '" + dimension + "' in the store's parameters");
      }
    }
  } catch (const json::exception& error) {
    throw StorageError(concat("the store's parameters cannot be read: ", error.what()));
  }
  return parameters;
}

}  // namespace faultsweep
