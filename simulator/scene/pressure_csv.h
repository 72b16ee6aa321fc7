#pragma once

#include <string>
#include <vector>

#include "simulator/scene/scene.h"

namespace faultsim {

/// What a pressure CSV holds, or why it could not be read.
struct PressureCsv {
  std::vector<PressureHistory> columns;  ///< one per column after the first, named by the header.
  std::string what;                      ///< "" = read; else what is wrong, with the line.
  std::string cure;
};

/// Reads "time [year], west [bar], east [bar]" and rows of numbers; times strictly increasing, at
/// time 0 only 0. Empty lines and lines that begin with # are skipped.
/// @param path   where the file is; @param given  its name for messages.
PressureCsv read_pressure_csv(const std::string& path, const std::string& given);

}  // namespace faultsim
