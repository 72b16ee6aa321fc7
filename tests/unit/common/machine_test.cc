#include "simulator/common/machine.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

/// A made-up /proc and /sys/fs/cgroup.
class MadeUpMachine : public testing::Test {
 protected:
  MadeUpMachine()
      : root_(std::filesystem::path(testing::TempDir()) / concat("faultsim_machine_", getpid())) {
    std::filesystem::remove_all(root_);
  }
  ~MadeUpMachine() override { std::filesystem::remove_all(root_); }
  void file(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::optional<double> available() const {
    return available_memory(root_ / "proc", root_ / "cgroup");
  }
  std::optional<double> cpus() const { return cgroup_cpus(root_ / "proc", root_ / "cgroup"); }
  std::filesystem::path root_;
};
using AvailableMemory = MadeUpMachine;
using CgroupCpus = MadeUpMachine;

TEST_F(AvailableMemory, IsUnknownWhereNobodySays) { EXPECT_FALSE(available().has_value()); }

TEST_F(AvailableMemory, IsTheHostsWithoutALimit) {
  file("proc/meminfo", "MemTotal: 2000 kB\nMemFree: 10 kB\nMemAvailable:   1000 kB\n");
  file("proc/self/cgroup", "0::/jobs/mine\n");
  file("cgroup/jobs/mine/memory.max", "max\n");
  file("cgroup/jobs/mine/memory.current", "5000\n");
  EXPECT_EQ(available(), 1024e3);
}

TEST_F(AvailableMemory, IsTheTightestGroupOnTheWayLessItsUseButNotItsFileCache) {
  file("proc/meminfo", "MemAvailable: 1000 kB\n");
  file("proc/self/cgroup", "1:cpu:/x\n0::/jobs/mine\n");
  file("cgroup/jobs/mine/memory.max", "900000\n");
  file("cgroup/jobs/mine/memory.current", "100000\n");
  EXPECT_EQ(available(), 800e3);
  file("cgroup/jobs/memory.max", "700000\n");
  file("cgroup/jobs/memory.current", "300000\n");
  file("cgroup/jobs/memory.stat", "anon 250000\ninactive_file 50000\n");
  EXPECT_EQ(available(), 450e3);
}

TEST_F(AvailableMemory, ReadsTheFirstVersionOfGroupsToo) {
  file("proc/meminfo", "MemAvailable: 1000 kB\n");
  file("proc/self/cgroup", "9:cpu,memory:/job\n");
  file("cgroup/memory/job/memory.limit_in_bytes", "600000\n");
  file("cgroup/memory/job/memory.usage_in_bytes", "200000\n");
  file("cgroup/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 50000\n");
  EXPECT_EQ(available(), 450e3);
}

TEST(AvailableMemoryHere, IsAPlausibleNumber) {
  const auto bytes = available_memory();
  ASSERT_TRUE(bytes.has_value());
  EXPECT_GT(*bytes, 1e6);
  EXPECT_LT(*bytes, 1e15);
}

TEST_F(CgroupCpus, AreThoseOfTheTightestGroupOnTheWay) {
  file("proc/self/cgroup", "0::/a/b\n");
  EXPECT_FALSE(cpus().has_value());
  file("cgroup/a/cpu.max", "150000 100000\n");
  file("cgroup/a/b/cpu.max", "max 100000\n");
  EXPECT_EQ(cpus(), 1.5);
  file("cgroup/a/b/cpu.max", "50000 100000\n");
  EXPECT_EQ(cpus(), 0.5);
}

TEST_F(CgroupCpus, OfTheFirstVersionHaveTheirOwnFiles) {
  file("proc/self/cgroup", "4:cpu:/job\n");
  file("cgroup/cpu/job/cpu.cfs_quota_us", "400000\n");
  file("cgroup/cpu/job/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cpus(), 4.0);
  file("cgroup/cpu/job/cpu.cfs_quota_us", "-1\n");
  EXPECT_FALSE(cpus().has_value());
  file("proc/self/cgroup", "4:memory:/job\n");
  file("cgroup/cpu/job/cpu.cfs_quota_us", "400000\n");
  EXPECT_FALSE(cpus().has_value());
}

TEST(UsableCores, IsAtLeastOne) { EXPECT_GE(usable_cores(), 1); }

}  // namespace
}  // namespace faultsim
