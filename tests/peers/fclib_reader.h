#pragma once

#include <filesystem>
#include <optional>

#include "simulator/result_files/fclib_writer.h"

namespace faultsim {

/// What FCLib's own library finds in a file.
struct FclibFile {
  FrictionalContactProblem problem;  ///< units are not FCLib's: left at 1.
  FrictionalContactInfo info;
  std::optional<FrictionalContactSolution> solution;
  double merit = -1;  ///< FCLib's merit function of the solution.
};

/// Reads a file with libfclib. Throws StorageError when the library refuses it.
FclibFile read_with_fclib(const std::filesystem::path& path);

}  // namespace faultsim
