#include "simulator/flow/eclipse_files.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace faultsim {
namespace {

namespace fs = std::filesystem;

std::string in_small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Endings are written in capitals or in small letters.
bool is_ending(const std::string& ending, const std::string& capitals) {
  return ending == capitals || ending == in_small_letters(capitals);
}

/// ".X0012": a report in a file of its own.
bool is_single_report(const std::string& ending) {
  return ending.size() == 6 && (ending[1] == 'X' || ending[1] == 'x') &&
         std::all_of(ending.begin() + 2, ending.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_eclipse_ending(const std::string& ending) {
  return is_ending(ending, ".EGRID") || is_ending(ending, ".UNRST") || is_single_report(ending);
}

/// The names of a case's files.
class CaseNames {
 public:
  /// @param path  one of them, or the case without an ending.
  explicit CaseNames(const fs::path& path) : root_(path) {
    const std::string ending = path.extension().string();
    if (ending.empty()) return;
    root_.replace_extension();
    prefers_small_ = is_eclipse_ending(ending) && ending == in_small_letters(ending);
  }

  const fs::path& root() const { return root_; }

  /// The one that is there; where both or none are, in the letters of the path that was given.
  fs::path with(const std::string& capitals) const {
    const fs::path capital = root_.string() + capitals,
                   small = root_.string() + in_small_letters(capitals);
    const fs::path& first = prefers_small_ ? small : capital;
    const fs::path& other = prefers_small_ ? capital : small;
    std::error_code error;
    return !fs::exists(first, error) && fs::exists(other, error) ? other : first;
  }

 private:
  fs::path root_;
  bool prefers_small_ = false;
};

}  // namespace

bool is_eclipse_name(const fs::path& path) {
  const std::string ending = path.extension().string();
  if (is_eclipse_ending(ending)) return true;
  std::error_code error;
  return ending.empty() && fs::exists(CaseNames(path).with(".EGRID"), error);
}

EclipseFiles eclipse_files(const fs::path& path) {
  const CaseNames names(path);
  const fs::path& root = names.root();
  EclipseFiles files{names.with(".EGRID"), names.with(".INIT"), {}};
  const fs::path unified = names.with(".UNRST");
  std::error_code error;
  if (is_single_report(path.extension().string())) {
    files.restarts = {path};
  } else if (fs::exists(unified, error)) {
    files.restarts = {unified};
  } else {
    const fs::path folder = root.has_parent_path() ? root.parent_path() : ".";
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const fs::path& file = entry.path();
      if (file.stem() == root.filename() && is_single_report(file.extension().string()))
        files.restarts.push_back(folder / file.filename());
    }
    std::ranges::sort(files.restarts);
  }
  return files;
}

}  // namespace faultsim
