#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "campaign/expansion/expansion.h"

/// tests/cases/bad_specs: every NN-name.json is refused with exactly the text of NN-name.txt.
namespace faultsweep {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(FAULTSIM_SOURCE_DIR) / "tests/cases/bad_specs";

std::vector<fs::path> bad_specs() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// What the user reads, with the folder taken out of file names.
std::string message_of(const fs::path& path) {
  std::string message;
  try {
    const auto expansion = expand(read_campaign(path.string()));
    message = "accepted with " + std::to_string(expansion.cases.size()) + " cases";
  } catch (const faultsim::InputError& error) {
    message = error.what();
  }
  const std::string folder = kFolder.string() + "/";
  for (auto at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
    message.erase(at, folder.size());
  }
  return message + "\n";
}

class BadSpecs : public testing::TestWithParam<fs::path> {};

TEST_P(BadSpecs, AreRefusedInFull) {
  fs::path expected = GetParam();
  expected.replace_extension(".txt");
  const std::string message = message_of(GetParam());
  if (std::getenv("FAULTSIM_REWRITE_EXPECTED") != nullptr) {
    std::ofstream(expected) << message;
    GTEST_SKIP() << "rewrote " << expected;
  }
  EXPECT_EQ(message, text_of(expected));
}

INSTANTIATE_TEST_SUITE_P(All, BadSpecs, testing::ValuesIn(bad_specs()), [](const auto& spec) {
  std::string name = spec.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(BadSpecs, AreMany) { EXPECT_GE(bad_specs().size(), 12u); }

}  // namespace
}  // namespace faultsweep
