#pragma once

#include <optional>
#include <string>

namespace faultsim {

/// Seconds from 1970-01-01 to an ISO 8601 date, "1990-01-31", with or without a time of day,
/// "1990-01-31T12:00:00" (UTC; a final Z is allowed). None = it is nothing of the kind.
std::optional<double> parse_date(const std::string& text);

/// The day of a time in seconds since 1970-01-01, "1990-01-31".
std::string date_text(double seconds);

}  // namespace faultsim
