#pragma once

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
/// The labels of a case (RankedCase::parameter_labels); "" where it has no such parameter.
std::vector<std::string> labels_from_json(const std::string& text);

}  // namespace faultsweep
