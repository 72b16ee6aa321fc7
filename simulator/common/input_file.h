#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace faultsim {

/// A file as it was read, or why it could not be.
struct InputText {
  std::string text;
  std::string what;  ///< "" = read; else what is wrong: "this is a folder".
  std::string cure;
};

/// Reads a regular file of at most `most_bytes`, whole. The one way in which inputs are opened:
/// never waits (a FIFO), never reads without end (/dev/zero), and a failed read is not the file's
/// end. What cannot be read is a value, as the caller knows where the name stood.
InputText read_input_file(const std::string& path, std::size_t most_bytes);

inline constexpr std::size_t kMostJsonBytes = 64'000'000;  ///< a scene is some kB.

/// Reads a regular file of any size piece by piece, with the same care, and keeps nothing of it.
/// @returns what is wrong, with an empty text.
InputText visit_input_file(const std::string& path,
                           const std::function<void(std::string_view)>& visit);

/// The fingerprint (fingerprint.h) of a file of any size. Throws InputError as below.
std::string fingerprint_of_file(const std::string& path);

/// A regular file of any size in the address space: pages of it are in memory while they are looked
/// at. Unlike a copy it must not be cut off meanwhile.
class MappedFile {
 public:
  /// Throws InputError with the path as its source.
  explicit MappedFile(const std::string& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::string_view text() const { return text_; }

 private:
  std::string_view text_;
};

/// As read_input_file; throws InputError with the path as its source.
std::string read_input_or_throw(const std::string& path, std::size_t most_bytes);

}  // namespace faultsim
