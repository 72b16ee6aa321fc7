#pragma once

#include <nlohmann/json_fwd.hpp>

#include "simulator/result/result.h"

namespace faultsim {

/// The whole result as JSON per schemas/result.schema.json (units in key names: "moment_nm",
/// "time_s", ...). No NaN: null. The same result gives the same text.
nlohmann::json result_to_json(const CaseResult& result);
/// Reads it back (all fields that are written). Throws StorageError on a wrong format version.
CaseResult result_from_json(const nlohmann::json& document);

}  // namespace faultsim
