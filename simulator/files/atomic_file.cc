#include "simulator/files/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

constexpr const char* kSuffix = ".tmp";
constexpr std::time_t kOneDay = 86400;

/// The host's name without the characters that separate the parts of a temporary name.
std::string host_name() {
  char name[256] = {};
  if (gethostname(name, sizeof name - 1) != 0 || name[0] == '\0') return "host";
  std::string text(name);
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '-');
  return text;
}

/// ".NAME.HOST.PID.COUNT.tmp"
std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> count = 0;
  return target.parent_path() / concat('.', target.filename().string(), '.', host_name(), '.',
                                       getpid(), '.', count++, kSuffix);
}

/// Makes the rename itself survive a power cut; where folders cannot be synced, nothing is lost
/// but that.
void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

/// The file that a name stands for: a rename would replace the link, or the device.
std::filesystem::path where_it_leads(const std::filesystem::path& target) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status link = fs::symlink_status(target, error);
  if (!fs::exists(link) || fs::is_regular_file(link)) return target;
  if (fs::is_regular_file(fs::status(target, error))) return fs::canonical(target, error);
  throw StorageError(concat("cannot write ", target.string(), ": it is not a regular file"));
}

/// Cuts the last part after a '.' off the text; "" when there is none.
std::string cut_last(std::string& text) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string::npos) return "";
  std::string part = text.substr(dot + 1);
  text.resize(dot);
  return part;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 10 && std::ranges::all_of(text, [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
  });
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path target) : target_(std::move(target)) {
  target_ = where_it_leads(target_);
  temporary_ = temporary_name(target_);
  descriptor_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(errno);
}

PendingFile::~PendingFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(temporary_.c_str());
}

void PendingFile::fail(int error_number) const {
  throw StorageError(concat("cannot write ", target_.string(), ": ", std::strerror(error_number)));
}

void PendingFile::write(const void* bytes, std::size_t n_bytes, std::size_t offset) {
  const char* next = static_cast<const char*>(bytes);
  while (n_bytes > 0) {
    const ssize_t written = pwrite(descriptor_, next, n_bytes, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    next += written;
    offset += static_cast<std::size_t>(written);
    n_bytes -= static_cast<std::size_t>(written);
  }
}

void PendingFile::sync() {
  if (fsync(descriptor_) != 0) fail(errno);
}

void PendingFile::commit() {
  sync();
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  const int descriptor = std::exchange(descriptor_, -1);
  if (close(descriptor) != 0 && errno != EINTR) fail(errno);
  sync_folder(target_.parent_path());
}

void create_folders(const std::filesystem::path& folder) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) {
    throw StorageError(concat("cannot create the folder ", folder.string(), ": ", error.message()));
  }
}

bool is_abandoned_temporary(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  if (name.empty() || name[0] != '.' || cut_last(name) != std::string(kSuffix).substr(1)) {
    return false;
  }
  const std::string count = cut_last(name);
  const std::string process = cut_last(name);
  const std::string host = cut_last(name);
  if (!is_number(count) || !is_number(process) || host.empty()) return false;
  if (host == host_name()) return kill(std::stoi(process), 0) != 0 && errno == ESRCH;
  struct stat info = {};
  return stat(path.c_str(), &info) == 0 && std::time(nullptr) - info.st_mtime > kOneDay;
}

std::uint64_t remove_abandoned_temporaries(const std::filesystem::path& folder) {
  std::uint64_t freed = 0;
  std::error_code error;
  std::filesystem::directory_iterator it(folder, error), end;
  if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
    return 0;
  for (; !error && it != end; it.increment(error)) {
    struct stat info = {};
    if (!is_abandoned_temporary(it->path()) || stat(it->path().c_str(), &info) != 0) continue;
    if (std::filesystem::remove(it->path(), error))
      freed += static_cast<std::uint64_t>(info.st_size);
    if (error) break;
  }
  if (error) {
    throw StorageError(concat("cannot clean up in ", folder.string(), ": ", error.message()));
  }
  return freed;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  PendingFile file(path);
  file.write(text.data(), text.size(), 0);
  file.commit();
}

}  // namespace faultsim
