#include "simulator/hdf5/disk_driver.h"

#if H5_VERSION_GE(1, 13, 2)
#include <H5FDdevelop.h>
#endif
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>

#include "simulator/common/errors.h"

namespace faultsim::hdf5 {
namespace {

/// What use_disk_driver hands to open_file; copied by HDF5 byte by byte.
struct Settings {
  int* first_error;
};

/// HDF5's part must come first: HDF5 knows the file by a pointer to it.
struct DiskFile {
  H5FD_t base;
  int descriptor;
  haddr_t end_of_allocation;
  haddr_t end_of_file;
  int* first_error;
};

DiskFile& as_file(H5FD_t* base) { return *reinterpret_cast<DiskFile*>(base); }
const DiskFile& as_file(const H5FD_t* base) { return *reinterpret_cast<const DiskFile*>(base); }

void remember(const DiskFile& file, int error_number) {
  if (file.first_error != nullptr && *file.first_error == 0) *file.first_error = error_number;
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t file_access, haddr_t) {
  const bool writes = (flags & H5F_ACC_RDWR) != 0;
  int how = (writes ? O_RDWR : O_RDONLY) | O_CLOEXEC;
  if ((flags & H5F_ACC_TRUNC) != 0) how |= O_TRUNC;
  if ((flags & H5F_ACC_CREAT) != 0) how |= O_CREAT;
  const int descriptor = open(name, how, 0666);
  struct stat info = {};
  if (descriptor < 0) return nullptr;
  auto* file = fstat(descriptor, &info) == 0 ? new (std::nothrow) DiskFile{} : nullptr;
  if (file == nullptr) {
    close(descriptor);
    return nullptr;
  }
  const auto* settings = static_cast<const Settings*>(H5Pget_driver_info(file_access));
  file->descriptor = descriptor;
  file->end_of_file = static_cast<haddr_t>(info.st_size);
  file->first_error = settings != nullptr ? settings->first_error : nullptr;
  return &file->base;
}

herr_t close_file(H5FD_t* base) {
  DiskFile* file = &as_file(base);
  if (close(file->descriptor) != 0 && errno != EINTR) remember(*file, errno);
  delete file;
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr) *flags = 0;
  return 0;
}

haddr_t get_end_of_allocation(const H5FD_t* base, H5FD_mem_t) {
  return as_file(base).end_of_allocation;
}

herr_t set_end_of_allocation(H5FD_t* base, H5FD_mem_t, haddr_t address) {
  as_file(base).end_of_allocation = address;
  return 0;
}

haddr_t get_end_of_file(const H5FD_t* base, H5FD_mem_t) { return as_file(base).end_of_file; }

herr_t read_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, size_t n_bytes, void* bytes) {
  const DiskFile& file = as_file(base);
  auto* next = static_cast<char*>(bytes);
  while (n_bytes > 0) {
    const ssize_t n_read = pread(file.descriptor, next, n_bytes, static_cast<off_t>(address));
    if (n_read < 0 && errno == EINTR) continue;
    if (n_read < 0) return -1;
    if (n_read == 0) {  // past the end: HDF5 wants zeros
      std::memset(next, 0, n_bytes);
      return 0;
    }
    next += n_read;
    address += static_cast<haddr_t>(n_read);
    n_bytes -= static_cast<size_t>(n_read);
  }
  return 0;
}

herr_t write_bytes(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t address, size_t n_bytes,
                   const void* bytes) {
  DiskFile& file = as_file(base);
  file.end_of_file = std::max(file.end_of_file, address + n_bytes);
  const auto* next = static_cast<const char*>(bytes);
  while (n_bytes > 0) {
    const ssize_t written = pwrite(file.descriptor, next, n_bytes, static_cast<off_t>(address));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      remember(file, errno);
      return 0;
    }
    next += written;
    address += static_cast<haddr_t>(written);
    n_bytes -= static_cast<size_t>(written);
  }
  return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t, hbool_t) {
  DiskFile& file = as_file(base);
  if (file.end_of_file == file.end_of_allocation) return 0;
  if (ftruncate(file.descriptor, static_cast<off_t>(file.end_of_allocation)) != 0) {
    remember(file, errno);
  }
  file.end_of_file = file.end_of_allocation;
  return 0;
}

H5FD_class_t make_class() {
  H5FD_class_t driver = {};
#if H5_VERSION_GE(1, 13, 2)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(600);  // 512 and up: private drivers
#endif
  driver.name = "faultsim_disk";
  driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(Settings);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = get_end_of_allocation;
  driver.set_eoa = set_end_of_allocation;
  driver.get_eof = get_end_of_file;
  driver.read = read_bytes;
  driver.write = write_bytes;
  driver.truncate = truncate_file;
  const H5FD_mem_t one_free_list_each[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(one_free_list_each, driver.fl_map);
  return driver;
}

}  // namespace

void use_disk_driver(hid_t file_access, int* first_error) {
  static const H5FD_class_t driver = make_class();
  static const hid_t id = H5FDregister(&driver);
  Settings settings = {};
  settings.first_error = first_error;
  FAULTSIM_DEMAND(id >= 0 && H5Pset_driver(file_access, id, &settings) >= 0, "driver id ", id);
}

}  // namespace faultsim::hdf5
