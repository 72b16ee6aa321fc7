#include "campaign/scheduler/resources.h"

#include <gtest/gtest.h>

#include <fstream>

#include "campaign/scheduler/progress.h"
#include "campaign/store/clock.h"

namespace faultsweep {
namespace {

namespace fs = std::filesystem;

class Cgroup : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "cgroup_XXXXXX";
    root_ = mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(root_); }
  void put(const std::string& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << "\n";
  }
  fs::path root_;
};

TEST_F(Cgroup, TheTightestLimitOnTheWayToTheRootCounts) {
  put("a/cpu.max", "150000 100000");
  put("a/b/cpu.max", "max 100000");
  EXPECT_EQ(cgroup_cpus(root_, "0::/a/b\n"), 1.5);
  put("a/b/cpu.max", "50000 100000");
  EXPECT_EQ(cgroup_cpus(root_, "0::/a/b\n"), 0.5);
  EXPECT_EQ(cgroup_cpus(root_, "0::/\n"), std::nullopt);
}

TEST_F(Cgroup, VersionOneHasItsOwnFiles) {
  put("cpu/job/cpu.cfs_quota_us", "400000");
  put("cpu/job/cpu.cfs_period_us", "100000");
  EXPECT_EQ(cgroup_cpus(root_, "4:cpu:/job\n"), 4.0);
  EXPECT_EQ(cgroup_cpus(root_, "4:memory:/job\n"), std::nullopt);
  put("cpu/job/cpu.cfs_quota_us", "-1");
  EXPECT_EQ(cgroup_cpus(root_, "4:cpu:/job\n"), std::nullopt);
}

TEST(Resources, ReadsSlurmNumbers) {
  EXPECT_EQ(slurm_number("8"), 8);
  EXPECT_EQ(slurm_number("8(x2),4"), 8);
  EXPECT_EQ(slurm_number(nullptr), std::nullopt);
  EXPECT_EQ(slurm_number(""), std::nullopt);
  EXPECT_EQ(slurm_number("-3"), std::nullopt);
  EXPECT_EQ(slurm_number("many"), std::nullopt);
}

TEST(Resources, KnowsThisMachine) {
  EXPECT_GE(available_cores(), 1);
  EXPECT_GT(available_memory(), 1e7);
  setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(available_cores(), 1);
  unsetenv("SLURM_CPUS_PER_TASK");
}

TEST(Progress, SaysHowFarAndHowLong) {
  const Progress progress{240, 117, 3, 130, "building 1 operator"};
  EXPECT_EQ(progress_bar(progress),
            "[###############...............] 120/240 cases, 3 failed, 2 min 10 s left, "
            "building 1 operator");
  EXPECT_EQ(progress_line({4, 4, 0, 0, ""}), "4 of 4 cases (100 %)");
  EXPECT_EQ(format_duration(3900), "1 h 05 min");
  EXPECT_EQ(format_duration(90000), "1 d 1 h");
}

}  // namespace
}  // namespace faultsweep
