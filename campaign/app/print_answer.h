#pragma once

#include <cstddef>

#include "campaign/app/commands.h"
#include "campaign/render/answer.h"

namespace faultsweep {

/// Prints the answer on stdout: as text at the width of the screen, as JSON or one of its tables as
/// CSV. Throws InputError where there is no such table.
void print_answer(const Answer& answer, const StoreArguments& common);

/// Columns of the terminal that stdout is; else those of COLUMNS, or kScreenWidth.
std::size_t screen_width();
/// What screen_width() gives from now on: --wide asks for one without end.
void set_screen_width(std::size_t width);

}  // namespace faultsweep
