#pragma once

#include <string>
#include <vector>

#include "simulator/common/exit_code.h"

namespace faultsim {

/// The `faultsim verify` command: runs verification problems and compares with their closed forms.
/// Tables go to stdout, progress to stderr.
///
/// @param names     problems ("V1") or cases ("V1-dip65"), any case; empty = all. An unknown name
/// is an
///                  InputError.
/// @param list      only prints names and titles.
/// @param json      prints one JSON document instead of tables.
/// @param slow      includes the cases marked slow; a case given by its full name is run anyway.
/// @param markdown  prints the tables of results/verification/figures.md.
/// @return done when every comparison passed; regress on any miss, or when nothing was compared.
ExitCode verify_command(const std::vector<std::string>& names, bool list, bool json, bool slow,
                        bool markdown = false);

}  // namespace faultsim
