#pragma once

#include <nlohmann/json.hpp>

/// The JSON values of campaigns; an ordered one keeps the order of the spec.
namespace faultsweep {

using nlohmann::json;
using nlohmann::ordered_json;

}  // namespace faultsweep
