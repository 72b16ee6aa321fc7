#pragma once

#include <string>
#include <vector>

namespace faultsweep {

/// A table for the screen: columns as wide as they need, numbers to the right, words to the left.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : header_(std::move(header)) {}
  /// @pre as many cells as the header has.
  void add_row(std::vector<std::string> cells);
  /// Lines, each ended; columns that are empty in every row are left out.
  std::string text() const;
  bool empty() const { return rows_.empty(); }

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

/// At most `digits` significant digits, without needless zeros: "0.52", "1.3e+15"; "-" for NaN.
std::string format_number(double value, int digits = 4);
/// Columns that the text takes on a screen: code points without combining ones, as all that we
/// print are one wide.
std::size_t display_width(const std::string& text);

}  // namespace faultsweep
