#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/store/records.h"
#include "simulator/common/units.h"

namespace faultsweep {

/// A parameter of a campaign as the store keeps it (CampaignInfo::parameters).
struct StoredParameter {
  std::string name;
  faultsim::Dimension dimension = faultsim::Dimension::number;
  bool is_text = false;
};

std::string parameters_to_json(const std::vector<StoredParameter>& parameters);
/// Throws StorageError when the text is not what parameters_to_json writes.
std::vector<StoredParameter> parameters_from_json(const std::string& text);
/// The texts of a case's parameters, one for each of the campaign's; "" where it has none.
std::vector<std::string> labels_of(const CaseParameters& values,
                                   const std::vector<StoredParameter>& parameters);
/// "offset = 100 m" of each parameter that the case has.
std::vector<std::string> settings_of(const CaseParameters& values,
                                     const std::vector<StoredParameter>& parameters);
/// SI, or words.
nlohmann::json value_to_json(const CaseParameter& value);
/// {"offset": {"value": 100, "unit": "m", "text": "100 m"}, ...}
nlohmann::json values_to_json(const CaseParameters& values,
                              const std::vector<StoredParameter>& parameters);

}  // namespace faultsweep
