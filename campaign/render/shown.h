#pragma once

#include <string>

#include "campaign/render/answer.h"

/// Cells as readers see them, on the screen as on the page.
namespace faultsweep {

/// At most `digits` significant digits, without needless zeros: "0.52", "1.3e+15"; numbers below
/// ten million plainly, "250" of two digits; "-" for NaN.
std::string format_number(double value, int digits = 4);
/// "12.5 bar", of a value in SI.
std::string in_unit(double value, const ShownUnit& unit, int digits = 4);
/// "18.9238690858494 deg" -> "18.9239 deg": a number, or one with a unit, of more than six
/// significant digits has six, or all in front of its point; whole numbers and other texts stay as
/// they are.
std::string short_number(const std::string& text);
/// "0.83 ± 0.02": the value to the place of the first digit of its error; of errors above 10 three
/// digits of it, and no fraction: "33 ± 10".
std::string with_error(double value, double error);
/// A share of 0 to 1 in percent, without the sign: "26.6"; "< 0.001" and "> 99.999" near the ends,
/// as nobody counts so many cases.
std::string format_percent(double share, int digits = 3);

/// "95 %", of an interval.
std::string confidence_text(double confidence);

/// What stands in the cell, its note behind a comma; "" where there is nothing. Texts are safe for
/// a terminal (printable.h).
std::string shown_cell(const AnswerCell& cell, const AnswerColumn& column);
/// "M0, N m".
std::string shown_heading(const AnswerColumn& column);

/// Columns that the text takes on a screen: code points without combining ones, as all that we
/// print are one wide.
std::size_t display_width(const std::string& text);

}  // namespace faultsweep
