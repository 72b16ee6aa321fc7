#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "campaign/render/render_text.h"
#include "campaign/render/shown.h"

namespace faultsweep {

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

inline constexpr double kBar = 1e5;  // Pa
/// The first fault that did something, and when: "F2 at step 7", "yes" where it has no name; ""
/// where none did.
std::string first_fault(bool any, const std::string& fault, const std::optional<int>& step);

}  // namespace faultsweep
