#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "simulator/common/ranges.h"

namespace faultsim {

/// A sealed file is an HDF5 file behind a user block of 4096 bytes. The block holds one line of
/// text with the length and checksum of all that follows, so that HDF5 never parses damaged bytes,
/// and large arrays can be used where they lie in the mapped file. Private to `cache`.
struct SealedFormat {
  const char* name;  ///< in the first line and in messages: "operator".
  int version;       ///< a file of another one is not used.
};

/// A sealed file whose bytes are known to be sound: tables are read by HDF5, arrays are mapped.
class SealedContent {
 public:
  SealedContent(hid_t file, const std::byte* bytes, std::size_t size,
                std::shared_ptr<const void> mapping)
      : file_(file), bytes_(bytes), size_(size), mapping_(std::move(mapping)) {}
  hid_t file() const { return file_; }
  /// The array (rows x columns, columns fastest) in the mapping; null if it has no value. Throws
  /// StorageError when it has another shape or lies at an odd place.
  /// @tparam Scalar  double or float.
  template <typename Scalar>
  const Scalar* mapped(const char* path, hsize_t rows, hsize_t columns) const;
  /// Keeps what mapped() returned alive.
  const std::shared_ptr<const void>& mapping() const { return mapping_; }

 private:
  hid_t file_;
  const std::byte* bytes_;
  std::size_t size_;
  std::shared_ptr<const void> mapping_;
};

/// Writes a sealed file: to a temporary name, read back and looked at, then renamed. Large arrays
/// must be contiguous. Throws StorageError (disk full, ...), leaving no partial file behind.
/// @param check  sees what was read back; throws StorageError when it is not what was written.
void write_sealed(const std::filesystem::path& path, const SealedFormat& format,
                  const std::function<void(hid_t)>& encode,
                  const std::function<void(const SealedContent&)>& check);

/// Opens a sealed file if it is there; format, numerics version and checksum are verified (the
/// checksum once per process and file). False if there is none, or none that can be used: one that
/// is damaged, or for which `decode` throws StorageError, is moved aside (".damaged") with a note
/// in `remark`; another format's stays, with a note, as does one that cannot be read.
bool read_sealed(const std::filesystem::path& path, const SealedFormat& format,
                 const std::function<void(const SealedContent&)>& decode, std::string* remark);

}  // namespace faultsim
