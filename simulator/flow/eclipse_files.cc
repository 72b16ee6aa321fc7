#include "simulator/flow/eclipse_files.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace faultsim {
namespace {

namespace fs = std::filesystem;

/// ".X0012": a report in a file of its own.
bool is_single_report(const std::string& ending) {
  return ending.size() == 6 && ending[1] == 'X' &&
         std::all_of(ending.begin() + 2, ending.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

bool is_eclipse_name(const fs::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".EGRID" || ending == ".UNRST" || is_single_report(ending)) return true;
  std::error_code error;
  return ending.empty() && fs::exists(path.string() + ".EGRID", error);
}

EclipseFiles eclipse_files(const fs::path& path) {
  const std::string ending = path.extension().string();
  fs::path root = path;
  if (!ending.empty()) root.replace_extension();
  EclipseFiles files{root.string() + ".EGRID", {}};
  std::error_code error;
  if (is_single_report(ending)) {
    files.restarts = {path};
  } else if (fs::exists(root.string() + ".UNRST", error)) {
    files.restarts = {root.string() + ".UNRST"};
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
