#include "campaign/scheduler/local_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "simulator/common/stopwatch.h"
#include "simulator/result/result_bytes.h"

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// The real runner with the fake simulator.
class LocalRunnerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::signal(SIGPIPE, SIG_IGN);
    options_.process.binary = FAKE_SIMULATOR;
    options_.host = "here";
    options_.rank = 3;
  }

  /// Runs one case per title (case ids from 1) until nothing is left.
  JobEvents run(const std::vector<std::string>& titles, const FamilyTask& task = {}) {
    LocalRunner runner(options_);
    runner.hold(1, "{\"strength\":\n0.7}");
    runner.begin_family(task);
    std::int64_t id = 0;
    for (const std::string& title : titles) {
      const std::string fields =
          task.fields_folder.empty() ? "" : task.fields_folder + "/" + std::to_string(id + 1);
      runner.add({++id, 1, "{\"/title\": \"" + title + "\"}", "test", fields, task.keep_fields});
    }
    JobEvents all;
    const faultsim::Stopwatch watch;
    while (!runner.is_idle() && watch.seconds() < 20) {
      const JobEvents events = runner.work(10);
      all.completed.insert(all.completed.end(), events.completed.begin(), events.completed.end());
      all.failed.insert(all.failed.end(), events.failed.begin(), events.failed.end());
      all.returned.insert(all.returned.end(), events.returned.begin(), events.returned.end());
      all.operators.insert(all.operators.end(), events.operators.begin(), events.operators.end());
      if (!events.building.empty()) all.building = events.building;
    }
    EXPECT_TRUE(runner.is_idle());
    return all;
  }
  static std::vector<std::int64_t> completed(const JobEvents& events) {
    std::vector<std::int64_t> ids;
    for (const auto& one : events.completed) ids.push_back(one.run.case_id);
    return ids;
  }

  LocalRunner::Options options_;
};

TEST_F(LocalRunnerTest, RunsCasesWithOneProcessAndOneOperator) {
  const JobEvents events = run({"a", "b", "c"});
  EXPECT_THAT(completed(events), ElementsAre(1, 2, 3));
  EXPECT_THAT(events.failed, IsEmpty());
  ASSERT_EQ(events.operators.size(), 1u);
  EXPECT_FALSE(events.operators[0].from_cache);
  EXPECT_EQ(events.building, "operator 3 of a surface");
  const auto result = faultsim::result_from_bytes(events.completed[0].result);
  EXPECT_EQ(result.whole.chi_bar, 0.7);
  EXPECT_EQ(result.steps.size(), 13u);
  EXPECT_EQ(events.completed[0].run.rank, 3);
  EXPECT_EQ(events.operators[0].seconds, 7);
  EXPECT_NEAR(events.completed[0].run.wall_seconds, 0.001, 1e-9);  // without the operator's 7 s
  EXPECT_EQ(events.completed[1].run.wall_seconds, 0.001);
}

TEST_F(LocalRunnerTest, ACrashIsOneFailedCaseAndTheOthersGoOn) {
  const JobEvents events = run({"a", "crash", "c", "d"});
  EXPECT_THAT(completed(events), ElementsAre(1, 3, 4));
  ASSERT_EQ(events.failed.size(), 1u);
  EXPECT_EQ(events.failed[0].run.case_id, 2);
  EXPECT_EQ(events.failed[0].run.status, RunStatus::crashed);
  EXPECT_EQ(events.failed[0].run.reason, "killed by SIGSEGV (11)");
  EXPECT_EQ(events.failed[0].run.signal, SIGSEGV);
  EXPECT_FALSE(events.failed[0].in_operator);
}

TEST_F(LocalRunnerTest, EachKindOfDeathHasItsReason) {
  const struct {
    const char* title;
    RunStatus status;
    const char* reason;
  } deaths[] = {
      {"exit", RunStatus::crashed, "ended with exit code 7"},
      {"killed", RunStatus::memory,
       "killed by SIGKILL (9), as the kernel does when memory runs out"},
      {"garbage", RunStatus::garbled, "wrote 'Residual norm 1.2e-3', which is not a reply"},
      {"half", RunStatus::garbled, "wrote '{\"event\": \"do', which is not a reply"},
      {"damaged", RunStatus::garbled,
       "sent a result that cannot be read: the result is cut off or was changed on its way: its "
       "checksum differs"},
      {"cut off", RunStatus::crashed, "ended with exit code 0"},
      {"wrong run", RunStatus::garbled, "replied to run 123456789 out of turn"},
      {"refuse", RunStatus::refused, "friction angle < 0"},
      {"refuse early", RunStatus::refused, "no such layer"},
  };
  for (const auto& death : deaths) {
    const JobEvents events = run({death.title, "good"});
    ASSERT_EQ(events.failed.size(), 1u) << death.title;
    EXPECT_EQ(events.failed[0].run.status, death.status) << death.title;
    EXPECT_EQ(events.failed[0].run.reason, death.reason) << death.title;
    EXPECT_THAT(completed(events), ElementsAre(2)) << death.title;
  }
}

TEST_F(LocalRunnerTest, AHangEndsAtTheTimeLimit) {
  FamilyTask task;
  task.time_limit = 0.3;
  const faultsim::Stopwatch watch;
  const JobEvents events = run({"a", "hang", "c"}, task);
  EXPECT_LT(watch.seconds(), 60);
  ASSERT_EQ(events.failed.size(), 1u);
  EXPECT_EQ(events.failed[0].run.status, RunStatus::hung);
  EXPECT_THAT(events.failed[0].run.reason, HasSubstr("exceeded its time limit of"));
  EXPECT_THAT(completed(events), ElementsAre(1, 3));
}

TEST_F(LocalRunnerTest, AnOperatorHasATimeLimitOfItsOwn) {
  FamilyTask task;
  task.operator_time_limit = 0.3;  // and none for cases
  const JobEvents events = run({"operator hang", "b"}, task);
  ASSERT_EQ(events.failed.size(), 1u);
  EXPECT_TRUE(events.failed[0].in_operator);
  EXPECT_EQ(events.failed[0].run.status, RunStatus::hung);
  EXPECT_THAT(events.failed[0].run.reason,
              HasSubstr("while building the operator: exceeded its time limit of 0.2999"));
  EXPECT_THAT(events.returned, ElementsAre(2));
  task.time_limit = 0.3;
  task.operator_time_limit = 60;
  EXPECT_EQ(run({"hang"}, task).failed.at(0).run.status, RunStatus::hung);
}

TEST_F(LocalRunnerTest, TheMemoryLimitEndsAGluttonAlone) {
  FamilyTask task;
  task.memory_limit = 3e8;
  const JobEvents events = run({"a", "allocate", "c"}, task);
  ASSERT_EQ(events.failed.size(), 1u);
  EXPECT_EQ(events.failed[0].run.status, RunStatus::memory);
  EXPECT_THAT(events.failed[0].run.log_tail, HasSubstr("out of memory"));
  EXPECT_THAT(completed(events), ElementsAre(1, 3));
}

TEST_F(LocalRunnerTest, AFailedOperatorBlamesTheFirstAndReturnsTheOthers) {
  const JobEvents events = run({"operator crash", "b", "c"});
  ASSERT_EQ(events.failed.size(), 1u);
  EXPECT_TRUE(events.failed[0].in_operator);
  EXPECT_EQ(events.failed[0].run.reason, "while building the operator: killed by SIGABRT (6)");
  EXPECT_THAT(events.returned, ElementsAre(2, 3));
}

TEST_F(LocalRunnerTest, AsksForFieldsWhereTheyAreKept) {
  std::string name = ::testing::TempDir() + "runner_XXXXXX";
  const std::filesystem::path folder = mkdtemp(name.data());
  FamilyTask task;
  task.keep_fields = KeepFields::stages;
  task.fields_folder = folder / "fields \"1\"";
  const JobEvents events = run({"a", "no fields", "crash", "d"}, task);
  EXPECT_THAT(completed(events), ElementsAre(1, 4));
  EXPECT_TRUE(events.completed[0].run.has_fields);
  std::string steps;
  std::ifstream(task.fields_folder + "/4/faults.h5") >> steps;
  EXPECT_EQ(steps, "stages");
  ASSERT_EQ(events.failed.size(), 2u);
  EXPECT_EQ(events.failed[0].run.status, RunStatus::garbled);
  EXPECT_EQ(events.failed[0].run.reason, "sent a result without the requested fault fields");
  EXPECT_FALSE(events.failed[0].run.has_fields);
  EXPECT_FALSE(run({"a"}).completed[0].run.has_fields) << "not asked for";
  std::filesystem::remove_all(folder);
}

TEST_F(LocalRunnerTest, LibrariesMayTalkOnStdout) {
  const JobEvents events = run({"noise", "exit", "noise"});
  EXPECT_THAT(completed(events), ElementsAre(1, 3));
  ASSERT_EQ(events.failed.size(), 1u);
  const std::string& tail = events.failed[0].run.log_tail;
  EXPECT_LE(tail.size(), SimulatorProcess::kLogTail);
  EXPECT_THAT(tail, HasSubstr("line 19999 of a library"));
}

TEST_F(LocalRunnerTest, TheSimulatorSeesNoTraceOfTheRank) {
  setenv("OMPI_COMM_WORLD_RANK", "1", 1);
  setenv("PMIX_RANK", "1", 1);
  setenv("SLURM_PROCID", "1", 1);
  setenv("FAULTSWEEP_KEEP", "me", 1);
  const JobEvents events = run({"environment"});
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "SLURM_PROCID"}) unsetenv(name);
  ASSERT_EQ(events.failed.size(), 1u);
  const std::string& tail = events.failed[0].run.log_tail;
  EXPECT_THAT(tail, Not(HasSubstr("OMPI_")));
  EXPECT_THAT(tail, Not(HasSubstr("PMIX_")));
  EXPECT_THAT(tail, Not(HasSubstr("SLURM_")));
  EXPECT_THAT(tail, HasSubstr("FAULTSWEEP_KEEP=me"));
}

TEST_F(LocalRunnerTest, ASimulatorThatCannotStartIsNoCasesFault) {
  options_.process.binary = "/nonexistent/faultsim";
  EXPECT_THROW(run({"a"}), faultsim::ResourceError);
  options_.process.binary = FAKE_SIMULATOR;
  setenv("FAKE_SIMULATOR_START", "9", 1);
  EXPECT_THROW(run({"a"}), faultsim::ResourceError);
  unsetenv("FAKE_SIMULATOR_START");
}

TEST_F(LocalRunnerTest, ASimulatorOfAnotherBuildIsRefusedOnceAndNotPerCase) {
  setenv("FAKE_SIMULATOR_OTHER_BUILD", "1", 1);
  try {
    run({"a", "b"});
    ADD_FAILURE() << "another build's results were taken";
  } catch (const faultsim::ResourceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is from another build than faultsweep"));
  }
  unsetenv("FAKE_SIMULATOR_OTHER_BUILD");
}

TEST_F(LocalRunnerTest, DrainingEndsTheCaseUnderWayAndReturnsTheOthers) {
  LocalRunner runner(options_);
  runner.begin_family({});
  runner.hold(1, R"({"title": "slow"})");
  for (int id = 1; id <= 4; ++id) runner.add({id, 1, "{}", "test", ""});
  std::vector<std::int64_t> done, returned;
  bool drained = false;
  const faultsim::Stopwatch watch;
  while (!runner.is_idle() && watch.seconds() < 10) {
    const JobEvents events = runner.work(5);
    for (const auto& one : events.completed) done.push_back(one.run.case_id);
    returned.insert(returned.end(), events.returned.begin(), events.returned.end());
    if (!drained && done.size() == 1 && watch.seconds() > 0.05) {
      usleep(30000);  // the second case is under way now
      runner.work(5);
      runner.drain();
      drained = true;
    }
  }
  EXPECT_THAT(done, ElementsAre(1, 2));
  EXPECT_THAT(returned, ElementsAre(3, 4));
}

TEST_F(LocalRunnerTest, TheSimulatorIsThePreferredVictimAndInItsOwnGroup) {
  SimulatorProcess process(options_.process);
  std::ifstream file("/proc/" + std::to_string(process.pid()) + "/oom_score_adj");
  int score = 0;
  file >> score;
  EXPECT_EQ(score, 1000);
  EXPECT_EQ(getpgid(process.pid()), process.pid());
  process.finish();
  process.exchange(10);
  EXPECT_EQ(process.wait(5).exit_code, 0);
}

}  // namespace
}  // namespace faultsweep
