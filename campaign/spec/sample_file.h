#pragma once

#include <string>
#include <vector>

namespace faultsweep {

/// Samples of parameters that somebody else has drawn, as CSV:
///
///   friction_angle [deg], cohesion [MPa], /biot
///   18.2, 0.31, 0.92
///   ...
///
/// as common/table_reader.h reads tables. Parameters without a unit are plain numbers; those in
/// [date] are ISO dates, 1990-01-31.
struct SampleFile {
  struct Column {
    std::string name;  ///< alias or JSON Pointer of a scene parameter.
    std::string unit;  ///< "" for plain numbers.
    std::vector<double> values;
    std::vector<std::string> dates;  ///< in place of values where the unit is "date".
  };
  std::vector<Column> columns;
  std::vector<std::string> names;  ///< of the rows; empty where they have none.
  long n_rows = 0;
  std::string fingerprint;  ///< of the text.
};

/// Reads the text; whether the scene has such parameters is not looked at.
/// @param name  for messages.
/// @param names_column  which has a name for each row, each another; "" = there is none.
/// @throws faultsim::InputError with what is wrong, line by line.
SampleFile parse_samples(const std::string& text, const std::string& name,
                         const std::string& names_column = "");

}  // namespace faultsweep
