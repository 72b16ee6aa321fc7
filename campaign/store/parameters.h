#pragma once

#include <string>
#include <vector>

#include "simulator/common/units.h"

namespace faultsweep {

/// A parameter of a campaign; those of a case are CaseParameters.
struct StoredParameter {
  std::string name;
  faultsim::Dimension dimension = faultsim::Dimension::number;
  bool is_text = false;
  bool operator==(const StoredParameter&) const = default;
};

/// The JSON array of {"name", "dimension"} that the store keeps.
std::string parameters_to_json(const std::vector<StoredParameter>& parameters);
/// Throws StorageError when the text is not what parameters_to_json writes.
std::vector<StoredParameter> parameters_from_json(const std::string& text);

}  // namespace faultsweep
