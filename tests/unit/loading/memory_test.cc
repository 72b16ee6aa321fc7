#include "simulator/loading/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "simulator/common/errors.h"

namespace faultsim {
namespace {

Plan plan_of(double bytes) {
  Plan plan;
  plan.memory_bytes = bytes;
  plan.n_unknowns = 391320;
  plan.n_jump = 2880;
  return plan;
}

TEST(DemandMemory, SaysWhatIsNeededWhatThereIsAndTheCure) {
  EXPECT_NO_THROW(demand_memory(plan_of(8e9), 8e9));
  EXPECT_NO_THROW(demand_memory(plan_of(8e9), std::nullopt));
  try {
    demand_memory(plan_of(8.04e9), 7.5e9);
    FAIL() << "accepted";
  } catch (const ResourceError& error) {
    const std::string text = error.what();
    for (const char* part :
         {"8.0 GB", "7.5 GB", "391320", "2880", "coarser tier", "plane strain"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
  }
  Plan plane = plan_of(8e9);
  plane.plane_strain = true;
  try {
    demand_memory(plane, 1e9);
    FAIL() << "accepted";
  } catch (const ResourceError& error) {
    EXPECT_NE(std::string(error.what()).find("larger cells"), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find("plane strain"), std::string::npos);
  }
}

/// A made-up /proc and /sys/fs/cgroup.
class AvailableMemory : public testing::Test {
 protected:
  AvailableMemory()
      : root_(std::filesystem::path(testing::TempDir()) / concat("faultsim_memory_", getpid())) {
    std::filesystem::remove_all(root_);
  }
  void file(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::optional<double> available() const {
    return available_memory(root_ / "proc", root_ / "cgroup");
  }
  std::filesystem::path root_;
};

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

}  // namespace
}  // namespace faultsim
