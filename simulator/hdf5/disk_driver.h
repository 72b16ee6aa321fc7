#pragma once

#include <hdf5.h>

namespace faultsim::hdf5 {

/// Makes the file access list use our file driver: plain reads and writes without locks, whose
/// failed writes are remembered instead of reported.
///
/// A file that HDF5 1.10 fails to close (disk full) stays in its tables and crashes the process at
/// exit. So a write never fails as far as HDF5 can see; whoever writes asks `*first_error` after
/// closing the file.
/// @param first_error  receives errno of the first failed write; outlives the file. May be null
///                     for a file that is only read.
void use_disk_driver(hid_t file_access, int* first_error);

}  // namespace faultsim::hdf5
