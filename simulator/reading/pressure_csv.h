#pragma once

#include <optional>
#include <string>
#include <vector>

namespace faultsim {

/// A column of a pressure CSV.
struct PressureColumn {
  std::string region;
  bool is_absolute = false;      ///< "west [bar] absolute"; else the change since time 0.
  std::vector<double> pressure;  ///< Pa, per row.
};

/// What a pressure CSV holds.
struct PressureCsv {
  std::vector<double> time;             ///< s since the start, strictly increasing, first >= 0.
  std::vector<PressureColumn> columns;  ///< named by the header, each name once.
  bool has_dates = false;               ///< rows begin with dates.
  std::optional<double> start;          ///< s since 1970, of time 0; the first date unless given.
};

/// Reads "time [year], west [bar], east [MPa]" and rows of numbers, or "date, west [bar] absolute"
/// and rows that begin with ISO 8601 dates (common/table_reader.h). A change at time 0 must be 0.
/// @param given  its name for messages.
/// @param start  s since 1970, the date of time 0; none = the date of the first row.
/// @throws InputError with all that is wrong, line by line.
PressureCsv parse_pressure_csv(const std::string& text, const std::string& given,
                               std::optional<double> start);

}  // namespace faultsim
