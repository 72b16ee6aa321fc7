#include "simulator/common/large_pages.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace faultsim {
namespace {

/// What the kernel was told of the mapping that holds an address: "hg" among it for large pages.
std::string flags_of(const void* address) {
  std::ifstream maps("/proc/self/smaps");
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  bool is_inside = false;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t from = 0, to = 0;
    char dash = 0;
    std::istringstream words(line);
    if (words >> std::hex >> from >> dash >> to && dash == '-') {
      is_inside = from <= wanted && wanted < to;
    } else if (is_inside && line.starts_with("VmFlags:")) {
      return line + " ";
    }
  }
  return {};
}

class LargePages : public testing::Test {
 protected:
  static constexpr std::size_t kBytes = 32 << 20;
  LargePages()
      : memory_(static_cast<char*>(
            mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))) {}
  ~LargePages() override { munmap(memory_, kBytes); }
  char* memory_;
};

TEST_F(LargePages, AreAskedForWhereTheKernelHasThem) {
  const bool has = std::filesystem::exists("/sys/kernel/mm/transparent_hugepage");
  ASSERT_EQ(flags_of(memory_ + kBytes / 2).find(" hg "), std::string::npos);
  ask_for_large_pages(memory_ + 1, kBytes - 2);
  const std::string flags = flags_of(memory_ + kBytes / 2);  // some sandboxes do not tell them
  if (has && !flags.empty()) {
    EXPECT_NE(flags.find(" hg "), std::string::npos);
  }
  std::fill_n(memory_, kBytes, 7);
  EXPECT_EQ(std::count(memory_, memory_ + kBytes, 7), static_cast<std::ptrdiff_t>(kBytes));
}

TEST_F(LargePages, AreNoMatterForTheSmallOrTheErrorNumber) {
  errno = 5;
  ask_for_large_pages(nullptr, 0);
  ask_for_large_pages(memory_, 100);
  ask_for_large_pages(memory_ + kBytes, 64 << 20);  // what is not mapped
  EXPECT_EQ(errno, 5);
}

}  // namespace
}  // namespace faultsim
