#pragma once

#include <string>

#include "campaign/answers/limit_table.h"

/// Inside of the module: what is known of a limit, in words that are not read as their contrary.
namespace faultsweep {

/// "-71 bar".
std::string value_text(double value, const LimitSearch& limit);
/// What was tried, from the safe end: "-110 to 0 bar".
std::string range_text(const LimitSearch& limit);
/// A value in the unit of the limit in SI.
double si_of(double value, const LimitSearch& limit);

/// As computed on these cells: "[-71, -70] bar", the last safe and the first unsafe value; "safe in
/// the whole range tried (-110 to 0 bar)"; "unsafe already at -110 bar"; "not known: ..."; of what
/// is not monotone also where it is unsafe.
std::string limit_text(const LimitCell& cell, const LimitSearch& limit);
/// What does not depend on the cells: the surely safe and the surely unsafe value as a bracket, or
/// the one that there is.
std::string sure_text(const LimitCell& cell, const LimitSearch& limit);
/// Whether the cells resolve, at both ends of the bracket or of the range, what is asked.
bool is_resolved(const LimitCell& cell);
/// What else there is to know: cases without a result, a search that is not at its end.
std::string remark_of(const LimitCell& cell);
/// What was asked: "storage_pressure: the highest value from ... without "slides" on F2".
std::string question_text(const LimitSearch& limit);

/// Headline, facts and the tables for files: `limits`, a row per configuration, fault and limit,
/// and `crossings`.
Answer limits_for_files(const LimitTable& table);

}  // namespace faultsweep
