#include "simulator/reading/horizon_csv.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "simulator/common/table_reader.h"

namespace faultsim {
namespace {

constexpr const char* kCure = "name the columns x [m], y [m], depth [m] (or thickness [m])";

/// Where the columns of a horizon stand: x, y, and depth, z or thickness.
struct HorizonColumns {
  std::array<std::optional<std::size_t>, 3> at;
  bool is_depth = false, is_thickness = false;
  bool are_all() const { return at[0] && at[1] && at[2]; }
};

/// Which coordinate a column is; 3: none.
std::size_t coordinate_of(std::string_view name) {
  if (name == "depth" || name == "thickness") return 2;
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  return static_cast<std::size_t>(std::ranges::find(kNames, name) - kNames.begin());
}

HorizonColumns find_columns(TableReader& table) {
  HorizonColumns found;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    const std::string name = table.columns()[k].name;
    const std::size_t coordinate = coordinate_of(name);
    if (coordinate == 3) {
      table.refuse("column " + table_quote(name) + " does not describe a horizon", kCure);
    } else if (found.at[coordinate]) {
      table.refuse("column " + table_quote(name) + " repeats another one", kCure);
    } else if (table.set_unit(k, Dimension::length, kLengthRange, kCure)) {
      found.at[coordinate] = k;
      found.is_depth = found.is_depth || name == "depth";
      found.is_thickness = found.is_thickness || name == "thickness";
    }
  }
  if (!found.are_all() && table.is_sound()) table.refuse("a column is missing", kCure);
  return found;
}

}  // namespace

HorizonTable parse_horizon_csv(const std::string& text, const std::string& given) {
  TableReader table(text, given);
  HorizonTable found;
  if (!table.has_header(kCure)) table.require_sound();
  const HorizonColumns columns = find_columns(table);
  table.require_sound();
  found.is_thickness = columns.is_thickness;
  while (table.next_row()) {
    const auto x = table.value(*columns.at[0]), y = table.value(*columns.at[1]),
               z = table.value(*columns.at[2]);
    if (!x || !y || !z) continue;
    if (columns.is_thickness && *z <= 0)
      table.refuse("a thickness is not above 0", "give every layer some thickness");
    found.points.emplace_back(*x, *y, columns.is_depth ? -*z : *z);
    found.line.push_back(table.line());
  }
  table.require_rows("write a line for each point");
  return found;
}

}  // namespace faultsim
