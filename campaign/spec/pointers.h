#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace faultsweep {

/// True if one pointer is the other or lies below it.
bool overlap(const std::string& a, const std::string& b);
/// A JSON scalar as the user reads it: text without quotes, shortest number.
std::string scalar_text(const nlohmann::json& value);

/// "40 GPa" in its two parts; nothing where it does not begin with a finite number.
struct NumberAndUnit {
  long double number = 0;
  std::string unit;  ///< "" for a plain number.
};
std::optional<NumberAndUnit> split_quantity(const std::string& text);

/// A number as a scene spells it: plain without a unit, else "20000000 Pa". Reads back the same.
nlohmann::json spelled(double number, const std::string& unit);

/// The shortest decimal text that reads back as the same bits; an exponent only where a person
/// would write one.
std::string shortest_text(double number);

}  // namespace faultsweep
