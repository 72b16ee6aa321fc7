#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace faultsweep {

/// True if one pointer is the other or lies below it.
bool overlap(const std::string& a, const std::string& b);
/// A JSON scalar as the user reads it: text without quotes, shortest number.
std::string scalar_text(const nlohmann::json& value);

/// The shortest decimal text that reads back as the same bits; an exponent only where a person
/// would write one.
std::string shortest_text(double number);

}  // namespace faultsweep
