#include "simulator/common/input_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "simulator/common/errors.h"
#include "simulator/common/fingerprint.h"
#include "simulator/common/printable.h"

namespace faultsim {
namespace {

namespace fs = std::filesystem;

class InputFile : public testing::Test {
 protected:
  InputFile() : folder_(fs::temp_directory_path() / ("input-file-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~InputFile() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

TEST_F(InputFile, IsReadWhole) {
  const std::string text = std::string(100'000, 'x') + std::string(1, '\0') + "end\n";
  std::ofstream(path("a"), std::ios::binary) << text;
  EXPECT_EQ(read_input_file(path("a"), 200'000).text, text);
  EXPECT_EQ(read_input_file(path("a"), 200'000).what, "");
  EXPECT_EQ(read_input_file(path("a"), text.size()).what, "") << "as many bytes as allowed";
  EXPECT_EQ(read_input_file(path("a"), text.size() - 1).what, "has 100005 bytes");
  EXPECT_EQ(read_input_file(path("a"), text.size() - 1).cure, "at most 100004 are read");
}

/// As files that do not fit into memory are, in pieces or mapped.
TEST_F(InputFile, IsLookedAtWithoutACopy) {
  std::string text;
  for (int i = 0; text.size() < 3'000'000; ++i) text += std::to_string(i) + "\n";
  std::ofstream(path("a"), std::ios::binary) << text;
  std::string pieces;
  EXPECT_EQ(visit_input_file(path("a"), [&](std::string_view piece) { pieces += piece; }).what, "");
  EXPECT_TRUE(pieces == text);  // too long to be compared line by line
  EXPECT_EQ(fingerprint_of_file(path("a")), fingerprint(text));
  EXPECT_TRUE(MappedFile(path("a")).text() == text);
  std::ofstream(path("empty")).close();
  EXPECT_EQ(MappedFile(path("empty")).text(), "");
  for (const std::string& odd : {folder_.string(), path("none"), std::string("/dev/zero")}) {
    EXPECT_THROW(MappedFile{odd}, InputError) << odd;
    EXPECT_THROW(fingerprint_of_file(odd), InputError) << odd;
  }
}

TEST_F(InputFile, IsARegularFileOrRefused) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(read_input_file(path("pipe"), 100).what, "this is a pipe") << "and does not wait";
  EXPECT_EQ(read_input_file("/dev/zero", 100).what, "this is a device");
  EXPECT_EQ(read_input_file(folder_.string(), 100).what, "this is a folder");
  EXPECT_THAT(read_input_file(path("none"), 100).what, testing::HasSubstr("cannot be read"));
  EXPECT_THAT(read_input_file(std::string("a\0b", 3), 100).what, testing::HasSubstr("NUL"));
  EXPECT_THAT(read_input_file(std::string(10'000, 'n'), 100).what,
              testing::HasSubstr("File name too long"));
}

/// /proc says that its files are empty, and reading this one fails.
TEST_F(InputFile, SaysWhenReadingFails) {
  EXPECT_GT(read_input_file("/proc/self/stat", 100'000).text.size(), 0U);
  EXPECT_THAT(read_input_file("/proc/self/mem", 100).what, testing::HasSubstr("cannot be read"));
}

TEST(Printable, SpellsOutWhatATerminalWouldObey) {
  EXPECT_EQ(printable("plain χ̄ ≤ 1 µm"), "plain χ̄ ≤ 1 µm");
  EXPECT_EQ(printable("\x1b[31m\r\x7f"), "\\u001b[31m\\u000d\\u007f");
  EXPECT_EQ(printable("\xc2\x9b"), "\\u009b") << "C1";
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a\\u202eb")
      << "written from right to left";
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\u0000b");
  EXPECT_EQ(printable("a\nb"), "a\\u000ab");
  EXPECT_EQ(printable("a\nb", Keep::line_ends), "a\nb");
  EXPECT_EQ(printable("\xff\xc3"
                      "x\xed\xa0\x80"),
            "\\xff\\xc3x\\xed\\xa0\\x80")
      << "no UTF-8";
  EXPECT_EQ(first_unprintable("fine"), "");
  EXPECT_EQ(first_unprintable("a\tb"), "\\u0009");
}

TEST(Shortened, CutsBetweenCharacters) {
  EXPECT_EQ(shortened("χχχ", 3), "χχχ");
  EXPECT_EQ(shortened("χχχ", 2), "χχ...");
}

}  // namespace
}  // namespace faultsim
