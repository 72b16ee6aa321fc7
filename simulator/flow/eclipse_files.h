#pragma once

#include <filesystem>
#include <vector>

namespace faultsim {

/// The files of a result in Eclipse's formats: CASE.EGRID with CASE.UNRST or CASE.X0000,
/// CASE.X0001, ... Endings may be in small letters.
struct EclipseFiles {
  std::filesystem::path grid;  ///< may not exist.
  std::filesystem::path init;  ///< CASE.INIT; may not exist.
  std::vector<std::filesystem::path>
      restarts;  ///< one unified file, or a file per report in order.
};

/// Whether a name is that of a grid, of a restart file or, without an ending, of a case.
bool is_eclipse_name(const std::filesystem::path& path);

/// The files that belong to one of them. A unified restart file goes before single ones, unless a
/// single one was named: then that one alone.
EclipseFiles eclipse_files(const std::filesystem::path& path);

}  // namespace faultsim
