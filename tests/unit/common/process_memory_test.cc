#include "simulator/common/process_memory.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace faultsim {
namespace {

/// A made-up /proc.
class Limits : public testing::Test {
 protected:
  Limits() {
    std::string name = testing::TempDir() + "faultsim_limits_XXXXXX";  // tests run side by side
    proc_ = mkdtemp(name.data());
    std::filesystem::create_directories(proc_ / "self");
    std::ofstream(proc_ / "self" / "status")
        << "Name:\tfaultsim\nVmPeak:\t 900 kB\nVmSize:\t 800 kB\nVmData:\t 300 kB\n";
  }
  ~Limits() override { std::filesystem::remove_all(proc_); }
  void set(const char* data, const char* address_space) const {
    std::ofstream(proc_ / "self" / "limits")
        << "Limit                     Soft Limit           Hard Limit           Units     \n"
        << "Max data size             " << data << "            unlimited            bytes     \n"
        << "Max stack size            8388608              unlimited            bytes     \n"
        << "Max address space         " << address_space << "            unlimited      bytes\n";
  }
  std::filesystem::path proc_;
};

TEST_F(Limits, AreNoneUnlessSet) {
  EXPECT_FALSE(left_in_limits(proc_ / "nowhere"));
  set("unlimited", "unlimited");
  EXPECT_FALSE(left_in_limits(proc_));
}

TEST_F(Limits, LeaveTheTighterOfDataAndAddressSpaceLessWhatEachCounts) {
  EXPECT_EQ(process_memory(proc_).data, 300 * 1024.0);
  EXPECT_EQ(process_memory(proc_).address_space, 800 * 1024.0);
  set("1024000", "unlimited");
  EXPECT_EQ(left_in_limits(proc_), 1024000 - 300 * 1024.0);
  set("1024000", "1000000");
  EXPECT_EQ(left_in_limits(proc_), 1000000 - 800 * 1024.0);
  set("1024000", "1000");
  EXPECT_EQ(left_in_limits(proc_), 0);
}

}  // namespace
}  // namespace faultsim
