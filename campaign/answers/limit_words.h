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
/// The same without its unit, to stand in a cell: "[-71, -70]", "all safe", "all unsafe"; " *":
/// safe again behind the limit; " ?": the cells do not resolve it there.
std::string short_text(const LimitCell& cell);
/// What does not depend on the cells: the surely safe and the surely unsafe value as a bracket, or
/// the one that there is.
std::string sure_text(const LimitCell& cell, const LimitSearch& limit);
/// Whether the cells resolve, at both ends of the bracket or of the range, what is asked.
bool is_resolved(const LimitCell& cell);
/// What else there is to know: cases without a result, a search that is not at its end.
std::string remark_of(const LimitCell& cell);
/// What was asked: "storage_pressure: the highest value from ... without "slides" on F2".
std::string question_text(const LimitSearch& limit);

/// Of a limit (index) what was tried, a row per configuration and fault in the table's order, the
/// first 40 of them: where it is safe, where it is not, and where it turns; none where no row has
/// it.
std::optional<faultsim::figure::RangeBars> limit_chart(const LimitTable& table, std::size_t place);

/// Headline, facts and the tables for files: `limits`, a row per configuration, fault and limit,
/// and `crossings`.
Answer limits_for_files(const LimitTable& table);

}  // namespace faultsweep
