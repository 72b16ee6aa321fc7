#pragma once

#include <string>

namespace faultsweep {

/// Time of day for rows of the store; never part of a result.
double seconds_since_1970();
/// "2026-03-01 14:05:09", local time.
std::string format_time(double seconds_since_1970);
/// "1 h 05 min", "3 min 20 s", "12 s".
std::string format_duration(double seconds);

}  // namespace faultsweep
