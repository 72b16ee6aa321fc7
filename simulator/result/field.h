#pragma once

#include <string_view>

#include "simulator/common/units.h"

namespace faultsim {

/// The dimension that the unit at the end of a key says: "max_slip_m" is a length.
constexpr Dimension dimension_of(std::string_view key) {
  if (key.ends_with("_m2")) return Dimension::area;
  if (key.ends_with("_m3")) return Dimension::potency;
  if (key.ends_with("_nm")) return Dimension::moment;
  if (key.ends_with("_pa")) return Dimension::pressure;
  if (key.ends_with("_m")) return Dimension::length;
  if (key.ends_with("_s")) return Dimension::time;
  return Dimension::number;
}
/// Of plane strain it is per metre of strike: an area, potency, moment or energy.
constexpr bool is_extensive(std::string_view key) {
  return key.ends_with("_m2") || key.ends_with("_m3") || key.ends_with("_nm") ||
         key.ends_with("_j");
}
/// "max_slip" of "max_slip_m", "event_magnitude" of "event_magnitude_mw".
constexpr std::string_view without_unit(std::string_view key) {
  const bool has_unit = dimension_of(key) != Dimension::number || key.ends_with("_mw");
  return has_unit ? key.substr(0, key.rfind('_')) : key;
}

/// An entry of the one list of a result's fields (result_fields.h): what JSON, the bytes between
/// processes, the store, comparisons and tables need to know of a member.
struct Field {
  /// Its key in JSON and its column in the store ("fault_id" of a name). Its end is its unit.
  std::string_view key;
  /// One sentence for users. Given: cases can be ranked and filtered by it.
  std::string_view meaning = {};
  /// In place of a column: SQL of one that it follows from; "$." is the row.
  std::string_view sql = {};
  /// How it is called as a metric; "" = the key without its unit.
  std::string_view called = {};
  /// Another name of the metric.
  std::string_view synonym = {};
  /// The store's version that its column came with; 0 = a migration in schemas/ has it. Results
  /// from before do not have it.
  int since = 0;
  /// May be NaN: no value. Of all other numbers NaN is a mistake.
  bool may_be_nan = false;

  std::string_view metric() const { return called.empty() ? without_unit(key) : called; }
};

}  // namespace faultsim
