#pragma once

#include <cstdint>
#include <filesystem>

namespace faultsim {

/// Where operators are kept; an empty folder = nowhere.
struct CachePolicy {
  std::filesystem::path folder;
  std::uint64_t max_bytes = 20'000'000'000;  ///< of either folder.
  /// If set, `folder` is on a network file system and this one on the host's own disk: operators
  /// are mapped from copies in it, as a mapped file that another host removes is gone at once.
  std::filesystem::path node_folder = {};
};

}  // namespace faultsim
