#include "simulator/cache/operator_cache.h"

#include <sys/stat.h>

#include <algorithm>
#include <tuple>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"

namespace faultsim {
namespace {

constexpr const char* kEnding = ".h5";
constexpr const char* kDamagedEnding = ".h5.damaged";

struct FoundFile {
  std::filesystem::path path;
  std::uint64_t bytes;
  timespec used;
  bool damaged;
};

/// All entries of the folder; none when it does not exist.
std::vector<std::filesystem::path> entries(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  std::filesystem::directory_iterator it(folder, error), end;
  if (error && error != std::errc::no_such_file_or_directory) {
    throw StorageError(concat("cannot list ", folder.string(), ": ", error.message()));
  }
  while (!error && it != end) {
    paths.push_back(it->path());
    it.increment(error);
  }
  return paths;
}

/// Operator files, also damaged ones: sound before damaged, then most recently used first.
/// Files that vanish meanwhile are left out.
std::vector<FoundFile> find_files(const std::filesystem::path& folder) {
  std::vector<FoundFile> files;
  for (const auto& path : entries(folder)) {
    const std::string name = path.filename().string();
    const bool damaged = name.ends_with(kDamagedEnding);
    struct stat info = {};
    if (name[0] == '.' || !(damaged || name.ends_with(kEnding))) continue;
    if (stat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) continue;
    files.push_back({path, static_cast<std::uint64_t>(info.st_size), info.st_mtim, damaged});
  }
  std::ranges::sort(files, [](const FoundFile& a, const FoundFile& b) {
    return std::tie(a.damaged, b.used.tv_sec, b.used.tv_nsec, a.path) <
           std::tie(b.damaged, a.used.tv_sec, a.used.tv_nsec, b.path);
  });
  return files;
}

/// Removes a file; true if this call did it.
bool remove_file(const std::filesystem::path& path) {
  std::error_code error;
  const bool removed = std::filesystem::remove(path, error);
  if (error) throw StorageError(concat("cannot remove ", path.string(), ": ", error.message()));
  return removed;
}

}  // namespace

std::vector<CacheEntry> list_operators(const std::filesystem::path& folder) {
  std::vector<CacheEntry> result;
  for (const FoundFile& file : find_files(folder)) {
    if (file.damaged) continue;
    result.push_back({file.path.stem().string(), file.bytes, file.used.tv_sec});
  }
  return result;
}

std::uint64_t prune_operators(const std::filesystem::path& folder, std::uint64_t max_bytes,
                              const std::string& keep) {
  std::uint64_t freed = remove_abandoned_temporaries(folder);
  const std::vector<FoundFile> files = find_files(folder);
  std::uint64_t total = 0;
  for (const FoundFile& file : files) total += file.bytes;
  for (auto file = files.rbegin(); file != files.rend() && total > max_bytes; ++file) {
    if (!file->damaged && file->path.filename() == keep + kEnding) continue;
    if (remove_file(file->path)) freed += file->bytes;
    total -= file->bytes;
  }
  return freed;
}

void keep(const CachePolicy& cache, const std::string& name, const char* what,
          const std::function<void()>& write, std::string& remark) {
  try {
    write();
    prune_operators(cache.folder, cache.max_bytes, name);
  } catch (const StorageError& error) {
    if (!remark.empty()) remark += "; ";
    remark += concat(what, " is not kept for other runs: ", error.what());
  }
}

}  // namespace faultsim
