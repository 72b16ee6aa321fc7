#pragma once

#include <optional>
#include <string>

#include "simulator/scene/scene.h"

namespace faultsim {

/// What a CSV of fault pressure holds.
struct FaultPressureCsv {
  FaultPressureTable table;
  bool has_dates = false;  ///< columns are headed by dates.
};

/// Reads p_f(s, t) on a fault: a row per place, a column per time.
///
///   depth [m], 0 year [bar], 1 year [bar], 2 year [bar]
///   along_dip [m], along_strike [m], 1990-01-01 [bar], 1995-01-01 [bar]
///
/// The first column is the depth of points or, in a box, their distance down dip from the centre of
/// the patch; the second, if it is there, the distance along strike from that centre (field: y),
/// and then every pair of both is a row. The changes are those since the first column of time,
/// which may hold pressures or changes (common/table_reader.h).
/// @param given  its name for messages.
/// @param start  s since 1970, the date of time 0; none = the first date.
/// @throws InputError with all that is wrong, line by line.
FaultPressureCsv parse_fault_pressure_csv(const std::string& text, const std::string& given,
                                          std::optional<double> start);

}  // namespace faultsim
