#include "simulator/files/output_target.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/files/result_folder.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStoreFile = "campaign.sqlite";

/// Nothing for an empty file, which may become anything.
std::optional<FileKind> kind_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(16, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(file.gcount());
  if (start.empty()) return std::nullopt;
  const bool sealed = start.starts_with("faultsim ");  // an HDF5 file behind a line of ours
  if (sealed || start.starts_with("\x89HDF\r\n")) return FileKind::hdf5;
  if (start.rfind("SQLite format 3", 0) == 0) return FileKind::database;
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && (start[first] == '{' || start[first] == '['))
    return FileKind::json;
  return FileKind::text;
}

fs::path above(const fs::path& path) {
  const fs::path parent = path.parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

/// The store that a folder is or lies in; empty when there is none.
fs::path store_around(const fs::path& folder) {
  std::error_code error;
  fs::path at = fs::weakly_canonical(folder, error);
  for (; !error && !at.empty(); at = at.parent_path()) {
    if (fs::exists(at / kStoreFile, error)) return at;
    if (at == at.parent_path()) break;
  }
  return {};
}

/// "out/" and "out" are one folder.
fs::path without_last_slash(const fs::path& path) {
  return path.has_filename() || path == path.root_path() ? path : path.parent_path();
}

/// What is wrong with the place where a name is to be made.
std::vector<Problem> problems_of_place(const fs::path& parent) {
  std::error_code error;
  const fs::file_status status = fs::status(parent, error);
  if (!fs::exists(status)) {
    return {{"", 0, concat("the folder ", parent.string(), " does not exist"),
             "make it first, or choose another"}};
  }
  if (!fs::is_directory(status)) {
    return {{"", 0, concat(parent.string(), " is not a folder"), "choose another place"}};
  }
  if (const fs::path store = store_around(parent); !store.empty()) {
    return {{"", 0, concat("it lies in the store ", store.string(), ", which holds campaigns only"),
             "choose a place outside it"}};
  }
  return {};
}

Problem problem_of_special_file(const fs::path& target, const fs::file_status& status) {
  const char* what = fs::is_directory(status) ? " is a folder"
                     : fs::is_symlink(status) ? " is a broken link"
                                              : " is not a regular file";
  return {"", 0, concat(target.string(), what),
          fs::is_directory(status) ? "name a file in it" : "name a file"};
}

std::vector<Problem> problems_of_file(const fs::path& target, FileKind kind,
                                      const std::vector<fs::path>& inputs) {
  if (!target.has_filename() || is_standard_output(target)) {
    return {{"", 0, concat("\"", target.string(), "\" is not the name of a file"), "name a file"}};
  }
  std::error_code error;
  fs::file_status status = fs::status(target, error);
  const fs::file_status link = fs::symlink_status(target, error);
  if (!fs::exists(status) && fs::is_symlink(link)) status = link;
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return {problem_of_special_file(target, status)};
  }
  const bool exists = fs::is_regular_file(status);
  std::vector<Problem> problems =
      problems_of_place(above(exists ? fs::canonical(target, error) : target));
  if (!exists) return problems;
  if (!input_at_or_below(target, inputs).empty()) {
    problems.push_back(
        {"", 0, concat(target.string(), " is read by this command"), "choose another name"});
  }
  if (const auto folder = contents_of(above(target));
      folder && folder->holds(target.filename().string())) {
    problems.push_back({"", 0,
                        concat(target.string(), " belongs to a result of `", folder->made_by, "`"),
                        "choose another name"});
  }
  const std::optional<FileKind> old = kind_of(target);
  if (old && *old != kind) {
    problems.push_back(
        {"", 0,
         concat(target.string(), " exists and is ", to_string(*old), ", not ", to_string(kind)),
         "choose another name, or remove it"});
  }
  return problems;
}

void collect_texts(const nlohmann::json& value, std::vector<std::string>& texts) {
  if (value.is_string()) texts.push_back(value.get<std::string>());
  if (!value.is_structured()) return;
  for (const nlohmann::json& one : value) collect_texts(one, texts);
}

}  // namespace

bool is_standard_output(const fs::path& target) {
  return target == "-" || target == "/dev/stdout" || target == "/dev/fd/1" ||
         target == "/proc/self/fd/1";
}

void require_writable_file(const std::string& option, const fs::path& target, FileKind kind,
                           const std::vector<fs::path>& inputs) {
  const std::vector<Problem> problems = problems_of_file(target, kind, inputs);
  if (!problems.empty()) throw InputError(option, problems);
}

void require_writable_folder(const std::string& option, const fs::path& folder) {
  if (is_standard_output(folder)) {
    throw InputError(option, "a folder cannot be written to standard output", "name a folder");
  }
  const fs::path target = without_last_slash(folder);
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw InputError(option, concat(target.string(), " is not a folder"), "name a folder");
  }
  const std::vector<Problem> problems =
      problems_of_place(fs::is_directory(status) ? target : above(target));
  if (!problems.empty()) throw InputError(option, problems);
}

std::vector<fs::path> files_named_in(const nlohmann::json& document, const fs::path& file) {
  std::vector<std::string> texts;
  collect_texts(document, texts);
  std::vector<fs::path> files = {file};
  for (const std::string& text : texts) {
    if (text.empty() || text.size() > 4096 || text.find('\0') != std::string::npos) continue;
    std::error_code error;
    const fs::path path = file.parent_path() / text;
    if (fs::is_regular_file(path, error)) files.push_back(path);
  }
  return files;
}

fs::path input_at_or_below(const fs::path& path, const std::vector<fs::path>& files) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(path, error);
  for (const fs::path& file : files) {
    if (fs::equivalent(path, file, error)) return file;
    for (fs::path at = fs::weakly_canonical(file, error); !error; at = at.parent_path()) {
      if (at == place) return file;
      if (at == at.parent_path()) break;
    }
  }
  return {};
}

}  // namespace faultsim
