#pragma once

#include <cstddef>
#include <string>

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

/// The same; throws InputError with the path as its source.
std::string read_input_or_throw(const std::string& path, std::size_t most_bytes);

}  // namespace faultsim
