#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "campaign/render/answer.h"

/// The renderings of an answer.
namespace faultsweep {

// Screen ------------------------------------------------------------------------------------------

/// The columns that a screen has, where nothing is said of it (a pipe).
constexpr std::size_t kScreenWidth = 100;

/// For a screen: sentences, then each table in one piece whatever the width. What does not vary
/// down a table is told as a sentence above it; headings take several lines; where columns still do
/// not fit, `extra` ones and then others are left out and named below it; where not even those that
/// are needed fit, each row is a paragraph. Charts are left to the page.
std::string render_text(const Answer& answer, std::size_t width = kScreenWidth);
std::string render_text(const AnswerTable& table, std::size_t width = kScreenWidth);
/// Text in lines of at most so many columns, broken at blanks; those that continue begin with
/// `indent` blanks. Words that are longer stand on lines of their own.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent = 0);

// JSON --------------------------------------------------------------------------------------------

/// {"format": 2, "headline": [sentences], facts of Answer::facts, table key: [rows as objects],
/// "columns": {table key: [{"key", "heading", "unit"}]}, "notes": [sentences]}. Numbers are in SI,
/// all digits, null where there is none; of a cell with an error or a note "KEY_error" and
/// "KEY_note" stand beside it. All rows, whatever a screen shows. @pre no two tables have the same
/// key.
inline constexpr int kAnswerFormat = 2;  ///< of commands.schema.json.
nlohmann::ordered_json render_json(const Answer& answer);
/// The rows of a table as objects, for documents of another format.
nlohmann::json json_rows(const AnswerTable& table);

// CSV ---------------------------------------------------------------------------------------------

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

// Page --------------------------------------------------------------------------------------------

/// A part of a page: paragraphs of class "answer" for the headline, then the blocks; cells read as
/// on the screen and carry the exact number in SI as data-value. No scripts, no styles.
std::string render_html(const Answer& answer);

/// The answer's first chart as SVG; "" where it has none.
std::string first_chart(const Answer& answer);

}  // namespace faultsweep
