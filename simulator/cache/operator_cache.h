#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "simulator/cache/cache_policy.h"
#include "simulator/model/fault_operator.h"

namespace faultsim {

/// Writes the operator to folder/FINGERPRINT.h5: to a temporary name, read back and checked against
/// its checksum, then renamed. H is one contiguous uncompressed dataset. Throws StorageError (disk
/// full, ...), leaving no partial file behind.
void write_operator(const FaultOperator& op, const std::filesystem::path& folder);

/// Opens folder/FINGERPRINT.h5 if it is there: format version, sizes, fingerprint and checksum are
/// verified (the checksum once per process and file); H is mapped read-only, so processes share its
/// pages. A damaged file, or what is not a file, is moved aside (".damaged") with a note in
/// `remark` and counts as absent, as does one that cannot be read.
std::optional<FaultOperator> read_operator(const std::filesystem::path& folder,
                                           const std::string& fingerprint,
                                           std::string* remark = nullptr);

struct CacheEntry {
  std::string fingerprint;
  std::uint64_t bytes;
  std::int64_t last_used;  ///< seconds since 1970 (the file's access mark, kept by read_operator).
};

/// Operators in the folder, most recently used first.
std::vector<CacheEntry> list_operators(const std::filesystem::path& folder);
/// Removes least recently used operators until the total is at most max_bytes, never `keep`.
/// Returns the bytes freed.
std::uint64_t prune_operators(const std::filesystem::path& folder, std::uint64_t max_bytes,
                              const std::string& keep);

/// Writes to a cache and prunes it, never the operator of that name. What cannot be kept is still
/// there for this run, so a full disk is a remark: "WHAT is not kept for other runs: ...".
void keep(const CachePolicy& cache, const std::string& name, const char* what,
          const std::function<void()>& write, std::string& remark);

}  // namespace faultsim
