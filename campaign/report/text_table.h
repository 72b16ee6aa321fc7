#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace faultsweep {

/// The columns that a screen is taken to have; tables keep within them.
constexpr std::size_t kScreenWidth = 100;

/// A table for the screen: columns as wide as they need, numbers to the right, words to the left.
/// What does not fit beside the first column stands below it, in blocks that repeat that column;
/// texts that are too long for a line go on in the next.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : header_(std::move(header)) {}
  /// Numbers are shortened to what a screen needs (short_number). @pre as many cells as the header
  /// has.
  void add_row(std::vector<std::string> cells);
  /// Lines, each ended; columns that are empty in every row are left out.
  std::string text() const { return text(width_); }
  std::string text(std::size_t width) const;
  /// What text() takes for the width from now on; --wide asks for one without end.
  static void set_screen_width(std::size_t width) { width_ = width; }
  bool empty() const { return rows_.empty(); }

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  static inline std::size_t width_ = kScreenWidth;
};

/// At most `digits` significant digits, without needless zeros: "0.52", "1.3e+15"; "-" for NaN.
std::string format_number(double value, int digits = 4);
/// "18.9238690858494 deg" -> "18.9239 deg": a number, or one with a unit, of more than six
/// significant digits has six; whole numbers and other texts stay as they are.
std::string short_number(const std::string& text);
inline constexpr double kBar = 1e5;  // Pa
/// The first fault that did something, and when: "F2 at step 7", "yes" where it has no name; ""
/// where none did.
std::string first_fault(bool any, const std::string& fault, const std::optional<int>& step);
/// Columns that the text takes on a screen: code points without combining ones, as all that we
/// print are one wide.
std::size_t display_width(const std::string& text);

}  // namespace faultsweep
