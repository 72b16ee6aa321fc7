#pragma once

#include <filesystem>

namespace faultsim {

/// A folder of its own among the temporary files, which goes with all that is in it.
class TemporaryFolder {
 public:
  /// Throws ResourceError where none can be made.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace faultsim
