#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace faultsim {

/// A file that gets its name only when it is complete: bytes go to a temporary name in the same
/// folder, commit() renames. Destroyed before commit() it leaves nothing behind. The temporary
/// name tells host and process, so that what a killed process leaves can be told from work in
/// progress (is_abandoned_temporary).
class PendingFile {
 public:
  /// Creates the temporary file. A target that is a link is written where it leads. Throws
  /// StorageError, also when the target is there and not a regular file.
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }
  /// Writes bytes at an offset, all of them. Throws StorageError (disk full, ...).
  void write(const void* bytes, std::size_t n_bytes, std::size_t offset);
  /// Brings the bytes to the disk; what fails late (quota, network disk) fails here.
  void sync();
  /// sync(), then gives the file its name, replacing an older one.
  void commit();
  /// Throws StorageError "cannot write TARGET: TEXT OF errno".
  [[noreturn]] void fail(int error_number) const;

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

/// Writes text to path by a temporary name and rename. Throws StorageError.
void write_text(const std::filesystem::path& path, const std::string& text);

/// Creates the folder and those above it where they are missing. Throws StorageError.
void create_folders(const std::filesystem::path& folder);

/// True if the name is a PendingFile's temporary one whose process is gone: a dead process of this
/// host, or untouched for a day on another host.
bool is_abandoned_temporary(const std::filesystem::path& path);
/// Removes such files from a folder, which may be missing; returns the bytes freed. Throws
/// StorageError when the folder cannot be listed or a file not be removed.
std::uint64_t remove_abandoned_temporaries(const std::filesystem::path& folder);

}  // namespace faultsim
