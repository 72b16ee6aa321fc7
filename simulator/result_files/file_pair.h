#pragma once

#include <hdf5.h>
#include <filesystem>
#include <string>
#include <vector>

#include "simulator/result_files/xdmf.h"

namespace faultsim {

/// Writes the HDF5 file that is in memory as folder/NAME.h5 with its folder/NAME.xmf. Both get
/// their names when both are complete. Throws StorageError and leaves nothing behind.
void write_file_pair(const std::filesystem::path& folder, const std::string& name, hid_t file,
                     const std::vector<XdmfGrid>& grids, const std::vector<double>& times);

}  // namespace faultsim
