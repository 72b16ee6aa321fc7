#include "campaign/scheduler/resources.h"

#include <gtest/gtest.h>

#include "campaign/scheduler/progress.h"
#include "campaign/scheduler/ranks.h"
#include "campaign/store/clock.h"

namespace faultsweep {
namespace {

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

TEST(Resources, TheManagerIsATaskOfASlurmJob) {
  EXPECT_EQ(default_workers(), available_cores());
  setenv("SLURM_NTASKS", "9", 1);
  EXPECT_EQ(default_workers(), 8);
  setenv("SLURM_NTASKS", "1", 1);
  EXPECT_EQ(default_workers(), available_cores());
  unsetenv("SLURM_NTASKS");
}

TEST(Resources, TheMemoryOfASlurmJobIsWhatItAskedFor) {
  constexpr double kMegabyte = 1024 * 1024;
  setenv("SLURM_MEM_PER_NODE", "7", 1);
  EXPECT_EQ(available_memory(), 7 * kMegabyte);
  unsetenv("SLURM_MEM_PER_NODE");
  setenv("SLURM_MEM_PER_CPU", "3", 1);
  setenv("SLURM_CPUS_ON_NODE", "4", 1);
  EXPECT_EQ(available_memory(), 12 * kMegabyte);
  unsetenv("SLURM_MEM_PER_CPU");
  unsetenv("SLURM_CPUS_ON_NODE");
}

TEST(Resources, OperatorsHaveAShareOfTheMemoryAlsoWhereItIsNotKnown) {
  EXPECT_EQ(memory_for_operators(10e9, 32e9).bytes, 9e9);
  EXPECT_EQ(memory_for_operators(10e9, 32e9).remark, "");
  EXPECT_GT(memory_for_operators(0.0, 32e9).bytes, 0) << "0 is no limit";
  EXPECT_LT(memory_for_operators(0.0, 32e9).bytes, 1e6);
  EXPECT_EQ(memory_for_operators({}, 32e9).bytes, 16e9);
  EXPECT_EQ(memory_for_operators({}, 32e9).remark,
            "it is not known how much memory is available: operators may have half of the physical "
            "memory, 16.0 GB, unless --memory is given");
  EXPECT_EQ(memory_for_operators({}, {}).bytes, 0);
  EXPECT_NE(memory_for_operators({}, {}).remark, "");
  EXPECT_GT(physical_memory(), 1e8);
}

TEST(NodeCache, IsAFolderOfOurOwnOnADisk) {
  const std::filesystem::path base = std::filesystem::path(FAULTSIM_BINARY_DIR) / "node_cache_test";
  std::filesystem::remove_all(base);
  std::filesystem::create_directory(base);
  const char* before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  setenv("TMPDIR", base.c_str(), 1);
  const std::filesystem::path folder = own_folder_on_disk();
  EXPECT_EQ(folder, base / ("faultsweep-operators-" + std::to_string(geteuid())));
  EXPECT_TRUE(std::filesystem::is_directory(folder));
  EXPECT_EQ(default_node_cache(base), "") << "the store is on a local disk";
  std::filesystem::permissions(folder, std::filesystem::perms(0777));
  EXPECT_EQ(own_folder_on_disk(), "") << "others may write there";
  setenv("TMPDIR", "/dev/shm", 1);
  EXPECT_EQ(own_folder_on_disk(), "") << "memory";
  setenv("TMPDIR", "/no/such/folder", 1);
  EXPECT_EQ(own_folder_on_disk(), "");
  before != nullptr ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
  std::filesystem::remove_all(base);
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
