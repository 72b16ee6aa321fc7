#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(FAULTSIM_SOURCE_DIR) / "tests/cases/bad_scenes";

std::string contents(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string message_of(const std::string& file) {
  try {
    read_scene(read_json_file(file));
  } catch (const InputError& error) {
    return std::string(error.what()) + "\n";
  }
  return "no error\n";
}

/// Each tests/cases/bad_scenes/NN-name.json is refused with exactly the text of NN-name.txt.
/// FAULTSIM_ACCEPT=1 rewrites the texts and reports itself as skipped.
TEST(BadScenes, AreRefusedWithTheTextsOnFile) {
  fs::current_path(kFolder);  // messages then print bare file names
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(".")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path().filename());
  }
  std::sort(files.begin(), files.end());
  ASSERT_GE(files.size(), 40U);
  const bool accept = std::getenv("FAULTSIM_ACCEPT") != nullptr;
  for (const std::string& file : files) {
    const fs::path expected = fs::path(file).replace_extension(".txt");
    if (accept) std::ofstream(expected) << message_of(file);
    EXPECT_EQ(message_of(file), contents(expected)) << file;
  }
  if (accept) GTEST_SKIP() << "texts rewritten, read them before committing";
}

}  // namespace
}  // namespace faultsim
