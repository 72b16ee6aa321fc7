#include "simulator/files/result_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "simulator/common/errors.h"
#include "simulator/common/ranges.h"
#include "simulator/files/atomic_file.h"
#include "simulator/files/output_target.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kContents = "contents.json";
constexpr const char* kMarker = "INCOMPLETE";
constexpr const char* kWork = "incomplete";
constexpr int kFolderFormat = 1;

/// Entries are named, not addressed: what a damaged list says can reach nothing outside.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name != kMarker && name != kWork &&
         name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
}

std::string marker_text(const std::string& why, const std::vector<std::string>& entries) {
  std::string text = why + "\n";
  for (const std::string& entry : entries) text += "entry: " + entry + "\n";
  return text;
}

/// The entries that a marker lists; nothing when there is no marker.
std::optional<std::vector<std::string>> marked_entries(const fs::path& folder) {
  std::ifstream file(folder / kMarker);
  if (!file) return std::nullopt;
  const std::string start = "entry: ";
  std::vector<std::string> entries;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(start, 0) != 0) continue;
    const std::string entry = line.substr(start.size());
    if (is_plain_name(entry)) entries.push_back(entry);
  }
  return entries;
}

void add_missing(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more) {
    if (!contains(names, name)) names.push_back(name);
  }
}

[[noreturn]] void fail(const char* doing, const fs::path& path, const std::string& why) {
  throw StorageError(concat("cannot ", doing, " ", path.string(), ": ", why));
}

void remove_path(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) fail("remove", path, error.message());
}

/// contents.json last: while it is there, what it lists is known to be ours.
void remove_entries(const fs::path& folder, const std::vector<std::string>& entries) {
  for (const std::string& entry : entries) {
    if (entry != kContents) remove_path(folder / entry);
  }
  remove_path(folder / kContents);
}

/// Its marker last: while that is there, the folder is known to be ours.
void remove_work(const fs::path& work) {
  std::error_code error;
  for (fs::directory_iterator it(work, error), end; !error && it != end; it.increment(error)) {
    if (it->path().filename() != kMarker) remove_path(it->path());
  }
  remove_path(work);
}

/// True for the folder of an unfinished result, or one that was just made for it.
bool is_work(const fs::path& work) {
  std::error_code error;
  return fs::is_regular_file(work / kMarker, error) || fs::is_empty(work, error) ||
         std::all_of(fs::directory_iterator(work, error), fs::directory_iterator(),
                     [](const fs::directory_entry& one) { return is_abandoned_temporary(one); });
}

std::vector<std::string> entries_of(const fs::path& folder) {
  std::vector<std::string> entries;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    entries.push_back(it->path().filename().string());
  }
  if (error) fail("list", folder, error.message());
  std::ranges::sort(entries);
  return entries;
}

}  // namespace

bool FolderContents::holds(const std::string& name) const { return contains(files, name); }

std::optional<FolderContents> contents_of(const fs::path& folder) {
  std::ifstream file(folder / kContents);
  if (!file) return std::nullopt;
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || json.value("format", nlohmann::json()) != kFolderFormat)
    return std::nullopt;
  const auto made_by = json.find("made_by"), files = json.find("files");
  if (made_by == json.end() || !made_by->is_string() || files == json.end() || !files->is_array())
    return std::nullopt;
  FolderContents contents{made_by->get<std::string>(), {}};
  for (const nlohmann::json& name : *files) {
    if (!name.is_string() || !is_plain_name(name.get<std::string>())) return std::nullopt;
    contents.files.push_back(name.get<std::string>());
  }
  return contents;
}

ResultFolder::ResultFolder(Request request) : request_(std::move(request)) {
  require_writable_folder(request_.option, request_.folder);
  folder_ = request_.folder.has_filename() ? request_.folder : request_.folder.parent_path();
  work_ = folder_ / kWork;
  const auto contents = contents_of(folder_);
  const auto marked = marked_entries(folder_);
  if (contents && contents->made_by != request_.made_by) {
    throw InputError(request_.option,
                     concat(folder_.string(), " holds a result of `", contents->made_by, "`"),
                     "choose another folder, or remove it");
  }
  whole_ = contents && !marked;
  if (contents) old_ = contents->files;
  if (marked) add_missing(old_, *marked);
  check_entries();
  start();
}

void ResultFolder::check_entries() const {
  std::vector<Problem> problems;
  std::vector<std::string> names = request_.names;
  names.emplace_back(kContents);
  std::error_code error;
  for (const std::string& name : names) {
    if (!fs::exists(fs::symlink_status(folder_ / name, error)) || contains(old_, name)) continue;
    problems.push_back(
        {"", 0,
         concat((folder_ / name).string(), " would be replaced and is not a result of `",
                request_.made_by, "`"),
         "choose another folder, or move the file away"});
  }
  if (fs::exists(fs::symlink_status(work_, error)) && !is_work(work_)) {
    problems.push_back({"", 0, concat(work_.string(), " is in the way and is not one of ours"),
                        "choose another folder, or move it away"});
  }
  std::vector<std::string> removed = old_;
  removed.emplace_back(kWork);
  for (const std::string& name : removed) {
    const fs::path input = input_at_or_below(folder_ / name, request_.inputs);
    if (input.empty()) continue;
    problems.push_back({"", 0,
                        concat(input.string(), " is read by this command and would be replaced"),
                        "choose another folder"});
  }
  if (!problems.empty()) throw InputError(request_.option, problems);
}

void ResultFolder::start() {
  std::error_code error;
  made_folder_ = fs::create_directory(folder_, error);
  if (error) fail("create the folder", folder_, error.message());
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) fail("open the folder", folder_, std::strerror(errno));
  // Some network disks have no locks; then two runs into one folder are the user's to avoid.
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock_);
    fail("write into", folder_, "another process writes its result there");
  }
  remove_abandoned_temporaries(folder_);  // of a marker whose writer was killed
  if (!whole_) {
    const std::string why = "This folder holds no complete result of `" + request_.made_by +
                            "`. What an unfinished one left is in incomplete/.";
    write_text(folder_ / kMarker, marker_text(why, old_));
    remove_entries(folder_, old_);
    old_.clear();
    write_text(folder_ / kMarker, marker_text(why, {}));
  }
  remove_work(work_);
  if (!fs::create_directory(work_, error)) fail("create the folder", work_, error.message());
  write_text(work_ / kMarker,
             marker_text("This result of `" + request_.made_by + "` was not completed.", {}));
}

ResultFolder::~ResultFolder() {
  if (lock_ < 0) return;
  std::error_code error;
  if (!keep_) {
    fs::remove_all(work_, error);
    if (!whole_ && made_folder_) {
      fs::remove(folder_ / kMarker, error);
      fs::remove(folder_, error);
    }
  }
  close(lock_);
}

void ResultFolder::commit() {
  FolderContents made{request_.made_by, {kContents}};
  for (const std::string& entry : entries_of(work_)) {
    if (entry != kMarker) made.files.push_back(entry);
  }
  std::ranges::sort(made.files);
  std::error_code error;
  for (const std::string& entry : made.files) {
    if (fs::exists(fs::symlink_status(folder_ / entry, error)) && !contains(old_, entry)) {
      fail("write", folder_ / entry, "something of this name has appeared meanwhile");
    }
  }
  write_text(
      work_ / kContents,
      nlohmann::json{{"format", kFolderFormat}, {"made_by", made.made_by}, {"files", made.files}}
              .dump(1) +
          "\n");
  replace(made);
  keep_ = true;
}

void ResultFolder::replace(const FolderContents& made) {
  std::vector<std::string> entries = old_;
  add_missing(entries, made.files);
  write_text(folder_ / kMarker,
             marker_text("This folder holds no complete result: `" + request_.made_by +
                             "` was stopped while it replaced the entries below.",
                         entries));
  if (whole_) remove_entries(folder_, old_);
  whole_ = false;
  const auto move = [&](const std::string& entry) {
    std::error_code error;
    fs::rename(work_ / entry, folder_ / entry, error);
    if (error) fail("write", folder_ / entry, error.message());
  };
  for (const std::string& entry : made.files) {
    if (entry != kContents) move(entry);
  }
  move(kContents);
  remove_work(work_);
  fsync(lock_);
  remove_path(folder_ / kMarker);
  fsync(lock_);
}

}  // namespace faultsim
