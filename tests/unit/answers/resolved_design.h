#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace faultsweep::testing {

/// What a store holds of a campaign's spec that answers look at: a design of that kind over
/// "friction" and "offset" at `screening`.
inline std::string resolved_design(const std::string& kind) {
  const nlohmann::json group = {{"kind", kind},
                                {"parameters", {{{"name", "friction"}}, {{"name", "offset"}}}},
                                {"scene", {{"tier", "screening"}}}};
  return nlohmann::json{{"groups", {group}}, {"exclude", nlohmann::json::array()}}.dump();
}

}  // namespace faultsweep::testing
