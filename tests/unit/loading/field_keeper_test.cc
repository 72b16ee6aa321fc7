#include "simulator/loading/field_keeper.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "simulator/common/errors.h"
#include "simulator/files/atomic_file.h"
#include "tests/unit/cache/example_operator.h"
#include "tests/unit/result_files/h5_file.h"

namespace faultsim {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Steps 0 | 1 2 3 | 4 5.
Scene two_stages() {
  Scene scene;
  scene.stages = {{"primary_production", 9.0, 3}, {"gas_storage", 4.0, 2}};
  return scene;
}

StepResult step_of(int number) {
  const LoadStep step = load_steps(two_stages()).at(static_cast<std::size_t>(number));
  StepResult result;
  result.step = number;
  result.stage = step.stage;
  result.time = step.time;
  result.outcome = Outcome::converged;
  return result;
}

/// Every value tells its step.
FaultFields fields_of(int number) {
  constexpr int kNodes = 4;
  FaultFields fields;
  fields.traction = Eigen::Matrix3Xd::Constant(3, kNodes, -1e6 * (number + 1));
  fields.jump = Eigen::Matrix3Xd::Constant(3, kNodes, 1e-3 * number);
  fields.critical_index = Eigen::VectorXd::Constant(kNodes, 0.1 * number);
  fields.static_critical_index = fields.critical_index;
  fields.state = Eigen::VectorXi::Zero(kNodes);
  fields.fault_pressure_change = Eigen::VectorXd::Constant(kNodes, -1e5 * number);
  return fields;
}

class FieldKeeperTest : public testing::Test {
 protected:
  /// Runs a case that reaches equilibrium up to `last`.
  std::vector<int> run(FieldSteps which, int last) {
    FieldKeeper keeper(folder(), which, two_stages(), op_.geometry);
    for (int number = 0; number <= last; ++number) keeper.add(step_of(number), fields_of(number));
    return keeper.finish();
  }
  std::filesystem::path folder() const { return scratch_.path() / "sweep" / "7"; }
  std::vector<double> steps_on_file() const {
    return H5File(folder() / "faults.h5").read("/step").values;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
      names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  ScratchFolder scratch_;
  FaultOperator op_ = example_operator("a");
};

TEST_F(FieldKeeperTest, KeepsAllSteps) {
  EXPECT_THAT(run(FieldSteps::all, 5), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(steps_on_file(), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(names(), ElementsAre("faults.h5", "faults.xmf"));
}

TEST_F(FieldKeeperTest, KeepsTheInitialStateAndTheEndsOfStagesWithTheirValues) {
  EXPECT_THAT(run(FieldSteps::stages, 5), ElementsAre(0, 3, 5));
  EXPECT_THAT(steps_on_file(), ElementsAre(0, 3, 5));
  const Dataset chi = H5File(folder() / "faults.h5").read("/faults/F1/steps/critical_index");
  EXPECT_THAT(chi.shape, ElementsAre(3, 20));  // both halves of the 12 nodes of a half domain
  EXPECT_EQ(chi.values[5], 0.1 * 0);
  EXPECT_EQ(chi.values[20 + 5], 0.1 * 3);
  EXPECT_EQ(chi.values[40 + 5], 0.1 * 5);
}

TEST_F(FieldKeeperTest, KeepsTheLastEquilibriumOfAHistoryThatEndsEarly) {
  EXPECT_THAT(run(FieldSteps::stages, 2), ElementsAre(0, 2));
  EXPECT_THAT(steps_on_file(), ElementsAre(0, 2));
  EXPECT_THAT(run(FieldSteps::stages, 3), ElementsAre(0, 3)) << "where a stage ends anyway";
  EXPECT_THAT(run(FieldSteps::stages, 4), ElementsAre(0, 3, 4));
  EXPECT_THAT(run(FieldSteps::stages, -1), IsEmpty()) << "no initial equilibrium";
}

TEST_F(FieldKeeperTest, KeepsTheOldFilesUntilTheNewOnesAreComplete) {
  run(FieldSteps::all, 5);
  const std::string before = read_bytes(folder() / "faults.h5");
  {
    FieldKeeper keeper(folder(), FieldSteps::stages, two_stages(), op_.geometry);
    keeper.add(step_of(0), fields_of(0));
  }
  EXPECT_EQ(read_bytes(folder() / "faults.h5"), before);
  run(FieldSteps::stages, 5);
  EXPECT_THAT(steps_on_file(), ElementsAre(0, 3, 5));
  EXPECT_THAT(names(), ElementsAre("faults.h5", "faults.xmf"));
}

TEST_F(FieldKeeperTest, RemovesWhatAKilledProcessLeftAndNothingElse) {
  create_folders(folder());
  const pid_t child = fork();
  if (child == 0) {
    PendingFile half(folder() / "faults.h5");
    half.write("half", 4, 0);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  ASSERT_EQ(names().size(), 1U);
  EXPECT_NE(names()[0], "faults.h5") << "a half file has no name that looks complete";
  const PendingFile ours(folder() / "other.h5");
  run(FieldSteps::all, 1);
  EXPECT_THAT(names(),
              ElementsAre(ours.temporary().filename().string(), "faults.h5", "faults.xmf"));
}

/// The kernel kills the writer in the middle of a file, at each of many places: SIGXFSZ at a limit.
TEST_F(FieldKeeperTest, AProcessKilledWhileItWritesLeavesNothingThatLooksComplete) {
  run(FieldSteps::all, 5);
  const auto size = std::filesystem::file_size(folder() / "faults.h5");
  run(FieldSteps::stages, 5);
  const std::string h5 = read_bytes(folder() / "faults.h5");
  const std::string xmf = read_bytes(folder() / "faults.xmf");
  for (const bool has_old : {false, true}) {
    for (rlim_t limit = 0; limit < size; limit += size / 7) {
      if (!has_old) std::filesystem::remove_all(folder());
      const pid_t child = fork();
      if (child == 0) {
        std::signal(SIGXFSZ, SIG_DFL);
        const rlimit small = {limit, limit};
        setrlimit(RLIMIT_FSIZE, &small);
        run(FieldSteps::all, 5);
        _exit(0);
      }
      int status = 0;
      waitpid(child, &status, 0);
      ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) << status;
      EXPECT_EQ(read_bytes(folder() / "faults.h5"), has_old ? h5 : "") << limit;
      EXPECT_EQ(read_bytes(folder() / "faults.xmf"), has_old ? xmf : "") << limit;
    }
    run(FieldSteps::stages, 5);
    EXPECT_THAT(names(), ElementsAre("faults.h5", "faults.xmf"));
    EXPECT_EQ(read_bytes(folder() / "faults.h5"), h5);
  }
}

TEST_F(FieldKeeperTest, AFolderThatCannotBeMadeIsAStorageError) {
  write_text(scratch_.path() / "sweep", "a file");
  EXPECT_THROW(run(FieldSteps::all, 5), StorageError);
}

TEST(FieldSteps, HaveTwoNames) {
  EXPECT_EQ(named<FieldSteps>("stages"), FieldSteps::stages);
  EXPECT_EQ(named<FieldSteps>("all"), FieldSteps::all);
  EXPECT_FALSE(named<FieldSteps>("none"));
}

}  // namespace
}  // namespace faultsim
