#pragma once

#include <optional>
#include <string>

#include "campaign/render/answer.h"

namespace faultsweep {

/// Which rendering a command prints.
struct Rendering {
  bool json = false;
  std::optional<std::string> csv = std::nullopt;  ///< the table of that key, "" = the first.
};

/// Prints the answer on stdout, as text at the width of the screen. Throws InputError where there
/// is no such table.
void print_answer(const Answer& answer, const Rendering& rendering);

/// Columns of the terminal that stdout is; else those of COLUMNS, or kScreenWidth.
std::size_t screen_width();
/// What screen_width() gives from now on: --wide asks for one without end.
void set_screen_width(std::size_t width);

}  // namespace faultsweep
