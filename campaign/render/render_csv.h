#pragma once

#include <string>
#include <string_view>

#include "campaign/render/answer.h"

namespace faultsweep {

/// Fewest digits that read back as the same bits; "nan" for NaN.
std::string exact_number(double value);
/// A field of a CSV file, in quotes where RFC 4180 wants them.
std::string csv_field(const std::string& text);
/// A text of a user as a field of a CSV file: what a terminal would obey is spelled out
/// (printable.h), and a "'" stands before what a spreadsheet would take for a formula, which begins
/// with "=", "+", "-" or "@" and is not a number with at most a unit.
std::string csv_name(const std::string& text);

/// One table: a line of keys, then all rows, numbers in SI with all digits, nothing where there is
/// none. Errors and notes have columns KEY_error and KEY_note where some row has one.
std::string render_csv(const AnswerTable& table);
/// The table of that key, "" = the first. Throws InputError that lists the tables there are.
const AnswerTable& table_named(const Answer& answer, std::string_view key);

}  // namespace faultsweep
