// Campaigns with the real faultsweep, under the real mpirun, with the fake simulator.
#include <nlohmann/json.hpp>

#include "tests/campaign/campaign_fixture.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Running : public testing::CampaignTest {};
class Trouble : public testing::CampaignTest {};
class Killing : public testing::CampaignTest {};

TEST_F(Running, FortyCasesWithTwoWorkersAndASecondRunDoesNothing) {
  const std::int64_t campaign = submit(std::vector<std::string>(40, "good"));
  const auto first = faultsweep({"run", "--workers", "2"});
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("40 of 40 cases (100 %)"));
  expect_each_case_completed_once(campaign, 40);
  const auto again = faultsweep({"run", "--workers", "2"});
  EXPECT_EQ(again.code, 0) << again.err;
  expect_each_case_completed_once(campaign, 40);
  const auto families = Store::open_reader(store_).family_progress(campaign);
  ASSERT_EQ(families.size(), 2u);
  EXPECT_NE(families[0].operator_fingerprint, families[1].operator_fingerprint);
}

TEST_F(Running, ResultsDoNotDependOnTheNumberOfWorkers) {
  submit(std::vector<std::string>(60, "good"));
  EXPECT_EQ(faultsweep({"run", "--workers", "1"}).code, 0);
  const auto one = faultsweep({"rank", "--json", "--top", "0"});
  std::filesystem::remove_all(store_);
  submit(std::vector<std::string>(60, "good"));
  EXPECT_EQ(faultsweep({"run", "--workers", "3"}).code, 0);
  const auto three = faultsweep({"rank", "--json", "--top", "0"});
  EXPECT_EQ(one.out, three.out);
  EXPECT_EQ(nlohmann::json::parse(one.out)["cases"].size(), 60u);
}

TEST_F(Running, ReadingCommandsAnswer) {
  submit({"good", "crash", "good", "good"});
  EXPECT_EQ(faultsweep({"run", "--workers", "1"}).code, 1);
  const auto status = faultsweep({"status", "--json"});
  EXPECT_EQ(status.code, 0);
  const auto counts = nlohmann::json::parse(status.out);
  EXPECT_EQ(counts["done"], 3);
  EXPECT_EQ(counts["failed"], 1);
  const auto rank =
      faultsweep({"rank", "--by", "chi_bar", "--where", "strength > 0.005", "--json"});
  EXPECT_EQ(nlohmann::json::parse(rank.out)["cases"][0]["case"], 4);
  const auto show = faultsweep({"show", "sweep/2", "--wide"});
  EXPECT_THAT(show.out, HasSubstr("killed by SIGSEGV (11)"));
  const auto history = faultsweep({"show", "3", "--wide"});
  EXPECT_THAT(history.out, HasSubstr("load steps:"));
  EXPECT_THAT(faultsweep({"explain", "1", "--wide"}).out,
              HasSubstr("will not run: it has a result"));
  EXPECT_THAT(faultsweep({"explain", "2", "--wide"}).out,
              HasSubstr("faultsweep retry sweep --case 2"));
  EXPECT_EQ(faultsweep({"retry"}).out, "1\n");
  EXPECT_THAT(faultsweep({"explain", "2", "--wide"}).out,
              HasSubstr("will run: it waits for another attempt"));
  EXPECT_EQ(faultsweep({"show", "99"}).code, 2);
  EXPECT_EQ(faultsweep({"rank", "--by", "nonsense"}).code, 2);
  EXPECT_EQ(faultsweep({"rank", "--where", "chi_bar > 3 bar"}).code, 2);
  EXPECT_EQ(faultsweep({"status", "other"}).code, 2);
  EXPECT_EQ(faultsweep({"cancel"}).code, 0);
  EXPECT_EQ(faultsweep({"run"}).code, 2);
}

TEST_F(Running, TheStarterSpecGoesFromInitToRanking) {
  // init takes no --store, so it is run by hand.
  const std::string init =
      std::string(FAULTSWEEP) + " init " + (folder_ / "my").string() + " >/dev/null 2>&1";
  ASSERT_EQ(std::system(init.c_str()), 0);
  EXPECT_NE(std::system(init.c_str()), 0) << "it must not overwrite";
  const std::string spec = folder_ / "my" / "campaign.json";
  const auto dry = faultsweep({"submit", spec, "--dry-run", "--json"});
  ASSERT_EQ(dry.code, 0) << dry.err;
  EXPECT_EQ(nlohmann::json::parse(dry.out)["cases"], 24);
  EXPECT_EQ(nlohmann::json::parse(dry.out)["families"].size(), 3u);
  EXPECT_FALSE(std::filesystem::exists(store_));
  const auto first = faultsweep({"submit", spec});
  EXPECT_EQ(first.code, 0);
  EXPECT_THAT(first.err, HasSubstr("Next: faultsweep run starter"));
  EXPECT_EQ(faultsweep({"run", "-w", "2"}).code, 0);
  const auto again = faultsweep({"submit", spec});
  EXPECT_THAT(again.err, HasSubstr("in the store already"));
  EXPECT_THAT(again.out, HasSubstr("24 have a result already"));
  const auto rank =
      faultsweep({"rank", "--where", "friction_angle < 25 deg and offset > 50 m", "--json"});
  EXPECT_EQ(nlohmann::json::parse(rank.out)["cases"].size(), 4u) << rank.err;
}

TEST_F(Running, TablesAndComparisonsAsAShellSeesThem) {
  submit({"good", "crash", "good", "good"});
  EXPECT_EQ(faultsweep({"run", "-w", "2"}).code, 1);
  const auto table = faultsweep({"export"});
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_EQ(std::count(table.out.begin(), table.out.end(), '\n'), 5);
  EXPECT_THAT(table.out, HasSubstr("\n2,identity-1,failed,,,crashed: killed by SIGSEGV (11),"));
  EXPECT_THAT(table.err, HasSubstr("4 cases of sweep, 1 without a result"));
  const std::string file = folder_ / "cases.csv";
  const auto to_file = faultsweep({"export", "sweep", "-o", file});
  EXPECT_EQ(to_file.out, "");
  std::ifstream written(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), table.out);
  EXPECT_EQ(faultsweep({"export", "--format", "salib", "-o", folder_ / "salib"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "salib" / "problem.json"));
  EXPECT_EQ(faultsweep({"export", "--format", "salib"}).code, 2);
  EXPECT_EQ(faultsweep({"export", "--format", "xls"}).code, 2);
  EXPECT_EQ(faultsweep({"export", "-o", "/dev/full/x"}).code, 2) << "a device is not a folder";

  EXPECT_EQ(faultsweep({"compare", "sweep"}).code, 2);
  EXPECT_EQ(faultsweep({"compare", "sweep", "sweep"}).code, 5) << "compares nothing";
  const std::filesystem::path other = folder_ / "other";
  std::filesystem::create_directories(other);
  EXPECT_EQ(faultsweep({"backup", other / "campaign.sqlite"}).code, 0);
  const auto same = faultsweep({"compare", "sweep", "--other-store", other});
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("in all 3 cases compared; 3 are identical"));
  // The crashed case is tried again and gets a result, in one of the stores.
  Store changed = Store::open_owner(other);
  ASSERT_EQ(changed.retry(1, false, {}), 1);
  RunRecord now_good;
  now_good.case_id = 2;
  now_good.status = RunStatus::completed;
  now_good.result = changed.stored_result(1);
  changed.record_runs(1, {now_good});
  const auto differs = faultsweep({"compare", "sweep", "--other-store", other, "--json"});
  EXPECT_EQ(differs.code, 5);
  const auto document = nlohmann::json::parse(differs.out);
  EXPECT_EQ(document["compared"], 4);
  EXPECT_EQ(document["other_outcome"], 1);
  EXPECT_EQ(document["worst"][0]["outcome_a"], "crashed");
  EXPECT_EQ(document["worst"][0]["outcome_b"], "converged");
}

TEST_F(Running, CancelAndRetrySayWhatTheyDidAndHowToGoOn) {
  Policy policy;
  policy.time_limit = 1;
  submit({"good", "hang", "good", "good", "good", "good", "good", "good"}, 0.5, policy);
  const pid_t run = start({"run", "-w", "1"});
  ASSERT_TRUE(wait_for_done(1));
  // By hand: `out` and `err` are those of the run.
  const std::string said = folder_ / "cancel";
  const std::string cancel =
      std::string(FAULTSWEEP) + " cancel --store " + store_.string() + " > " + said + " 2>&1";
  ASSERT_EQ(std::system(cancel.c_str()), 0);
  const auto end = wait(run);
  const auto left = Store::open_reader(store_).campaign("");
  EXPECT_GT(left.n_waiting, 0) << end.err;
  EXPECT_EQ(left.n_done + left.n_failed + left.n_waiting, 8);
  EXPECT_THAT(text("cancel"), HasSubstr("sweep is cancelled with "));
  EXPECT_THAT(text("cancel"), HasSubstr("Its manager hands out no more cases"));
  const auto again = faultsweep({"cancel"});
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, HasSubstr("sweep was already cancelled with " +
                                   std::to_string(left.n_waiting) + " of 8 cases waiting"));
  EXPECT_THAT(again.err, HasSubstr("faultsweep submit sweep.json reopens it"));
  EXPECT_THAT(faultsweep({"explain", "8", "--wide"}).out,
              HasSubstr("will not run: the campaign is cancelled; `faultsweep submit sweep.json`"));
  EXPECT_THAT(faultsweep({"explain", "1", "--wide"}).out,
              HasSubstr("will not run: it has a result"));
  EXPECT_EQ(faultsweep({"cancel", "other"}).code, 2);
  submit({"good", "hang", "good", "good", "good", "good", "good", "good"}, 0.5, policy);
  EXPECT_FALSE(Store::open_reader(store_).campaign("").cancelled) << "submitting reopens";
  EXPECT_EQ(faultsweep({"run", "-w", "2"}).code, 1);

  const auto full = faultsweep({"retry", "--case", "1"});
  EXPECT_EQ(full.out, "0\n");
  EXPECT_THAT(full.err, HasSubstr("case 1 has a full result (converged)"));
  EXPECT_EQ(faultsweep({"retry", "--case", "99"}).code, 2);
  const auto hung = faultsweep({"retry", "--case", "2"});
  EXPECT_EQ(hung.out, "1\n");
  EXPECT_THAT(hung.err, HasSubstr("1 case of sweep waits again. Next: faultsweep run sweep"));
  EXPECT_THAT(faultsweep({"retry", "--case", "2"}).err, HasSubstr("case 2 is waiting already"));
  EXPECT_EQ(faultsweep({"run", "-w", "1"}).code, 1);
  EXPECT_THAT(faultsweep({"explain", "2", "--wide"}).out, HasSubstr("attempt 2 hung"));
  EXPECT_THAT(faultsweep({"retry"}).out, "1\n");
}

TEST_F(Trouble, EveryKindOfFailureIsARowAndTheOthersAreDone) {
  Policy policy;
  policy.time_limit = 3;  // the glutton takes a second on a busy machine
  policy.memory_limit = 3e8;
  const std::vector<std::string> titles = {"good", "crash",  "good", "garbage",  "good",
                                           "exit", "hang",   "good", "allocate", "refuse",
                                           "good", "killed", "noise"};
  const std::int64_t campaign = submit(titles, 0, policy);
  const auto end = faultsweep({"run", "--workers", "2"});
  EXPECT_EQ(end.code, 1) << end.err;
  Store store = Store::open_reader(store_);
  EXPECT_EQ(store.campaign("").n_done, 6);
  EXPECT_EQ(store.campaign("").n_failed, 7);
  const auto run_of = [&](const char* position) {
    return store.stored_case(campaign, position).runs.at(0);
  };
  EXPECT_EQ(run_of("2").reason, "killed by SIGSEGV (11)");
  EXPECT_EQ(run_of("4").status, "garbled");
  EXPECT_EQ(run_of("6").exit_code, 7);
  EXPECT_EQ(run_of("7").status, "hung");
  EXPECT_EQ(run_of("9").status, "memory");
  EXPECT_EQ(run_of("10").reason, "friction angle < 0");
  EXPECT_THAT(run_of("12").reason, HasSubstr("killed by SIGKILL"));
}

TEST_F(Trouble, AFamilyWithoutOperatorIsGivenUpAndTheOthersRun) {
  std::vector<std::string> titles(20, "good");
  for (std::size_t k = 0; k < titles.size(); k += 2) titles[k] = "operator crash";
  submit(titles);
  EXPECT_EQ(faultsweep({"run", "--workers", "2"}).code, 1);
  Store store = Store::open_reader(store_);
  EXPECT_EQ(store.campaign("").n_done, 10);
  EXPECT_EQ(store.campaign("").n_failed, 10);
}

TEST_F(Trouble, ASimulatorThatDoesNotStartStopsTheCampaign) {
  submit(std::vector<std::string>(10, "good"));
  const auto dead = faultsweep({"run", "-w", "1"}, [] { setenv("FAKE_SIMULATOR_START", "9", 1); });
  EXPECT_EQ(dead.code, 4) << dead.err;
  EXPECT_THAT(dead.err, HasSubstr("before it said hello"));
  const auto missing =
      faultsweep({"run", "-w", "1"}, [] { setenv("FAULTSIM_BINARY", "/no/faultsim", 1); });
  EXPECT_EQ(missing.code, 4);
  EXPECT_EQ(Store::open_reader(store_).campaign("").n_waiting, 10);
}

TEST_F(Trouble, ASimulatorKilledBeforeItSaysHelloIsTriedAgain) {
  Policy policy;
  policy.on_failure = FailureAction::retry;
  const std::int64_t campaign = submit(std::vector<std::string>(10, "good"), 0, policy);
  const std::string once = (folder_ / "killed").string();
  const auto end = faultsweep({"run", "-w", "1"},
                              [&] { setenv("FAKE_SIMULATOR_KILLED_ONCE", once.c_str(), 1); });
  EXPECT_EQ(end.code, 0) << end.err;
  EXPECT_TRUE(std::filesystem::exists(once));
  Store store = Store::open_reader(store_);
  EXPECT_EQ(store.campaign("").n_done, 10);
  EXPECT_THAT(store.stored_case(campaign, "1").runs.at(0).reason,
              HasSubstr("before it said hello: killed by SIGKILL"));
}

TEST_F(Trouble, AFullDiskEndsWithFourAndKeepsWhatWasStored) {
  const std::int64_t campaign = submit(std::vector<std::string>(400, "good"), 0.002);
  const pid_t starter = start({"run", "-w", "1"});
  ASSERT_TRUE(wait_for_done(5));
  const rlimit limit = {400000, 400000};  // bytes per file: soon the WAL has no room
  const auto owner = Store::open_reader(store_).owner();
  ASSERT_TRUE(owner);
  ASSERT_EQ(prlimit(static_cast<pid_t>(owner->pid), RLIMIT_FSIZE, &limit, nullptr), 0);
  const auto end = wait(starter);
  EXPECT_EQ(end.code, 4) << end.err;
  EXPECT_THAT(end.err, Not(HasSubstr("MPI_ABORT")));
  const std::string last_line = end.err.substr(end.err.rfind('\n', end.err.size() - 2) + 1);
  EXPECT_THAT(last_line, HasSubstr("faultsweep: the store "));
  EXPECT_THAT(last_line, HasSubstr("what is stored is intact"));
  EXPECT_THAT(Store::open_reader(store_).integrity_problems(), ::testing::IsEmpty());
  EXPECT_EQ(faultsweep({"run", "-w", "2"}).code, 0);
  expect_each_case_completed_once(campaign, 400);
}

TEST_F(Trouble, AnUnwritableStoreEndsWithFour) {
  submit({"good"});
  const auto own = geteuid() == 0 ? [] { if (setgid(65534) != 0 || setuid(65534) != 0) _exit(126); }
                                  : [] {};
  std::filesystem::permissions(folder_, std::filesystem::perms(0755));
  std::filesystem::permissions(store_, std::filesystem::perms(0555));
  std::ofstream(folder_ / "out").close();
  const auto end = faultsweep({"run", "-w", "1"}, own);
  std::filesystem::permissions(store_, std::filesystem::perms(0755));
  if (end.code == 127) GTEST_SKIP() << "the build folder is closed to other users";
  EXPECT_EQ(end.code, 4) << end.err;
  EXPECT_EQ(Store::open_reader(store_).campaign("").n_waiting, 1);
  store_ = "/proc/no-store-here";
  EXPECT_EQ(faultsweep({"run"}).code, 4);
}

TEST_F(Killing, AKilledManagerIsReplacedWithoutAHuman) {
  const std::int64_t campaign = submit(std::vector<std::string>(200, "good"), 0.01);
  const pid_t starter = start({"run", "--workers", "2"});
  ASSERT_TRUE(wait_for_done(20));
  const auto owner = Store::open_reader(store_).owner();
  ASSERT_TRUE(owner);
  kill(static_cast<pid_t>(owner->pid), SIGKILL);
  const auto end = wait(starter);
  EXPECT_EQ(end.code, 0) << end.err;
  expect_each_case_completed_once(campaign, 200);
  std::string kinds;
  for (const EventRecord& event : Store::open_reader(store_).events(campaign, 20))
    kinds += event.kind + " ";
  EXPECT_THAT(kinds, HasSubstr("restart"));
  EXPECT_THAT(kinds, HasSubstr("takeover"));
}

TEST_F(Killing, AKilledWorkerIsReplacedAndLeavesNoSimulator) {
  const std::int64_t campaign = submit(std::vector<std::string>(200, "good"), 0.01);
  const pid_t starter = start({"run", "--workers", "2"});
  ASSERT_TRUE(wait_for_done(20));
  pid_t worker = 0;
  std::vector<pid_t> simulators;
  for (const pid_t mpirun : children_of(starter)) {
    for (const pid_t rank : children_of(mpirun)) {
      if (const auto children = children_of(rank); !children.empty()) {
        worker = rank;
        simulators = children;
      }
    }
  }
  ASSERT_GT(worker, 0);
  kill(worker, SIGKILL);
  usleep(2000000);
  for (const pid_t simulator : simulators) EXPECT_FALSE(is_running(simulator));
  const auto end = wait(starter);
  EXPECT_EQ(end.code, 0) << end.err;
  expect_each_case_completed_once(campaign, 200);
}

TEST_F(Killing, AKilledMpirunIsReplacedAndItsManagerLeavesTheStore) {
  const std::int64_t campaign = submit(std::vector<std::string>(400, "good"), 0.01);
  const pid_t starter = start({"run", "--workers", "2"});
  for (long wanted : {20, 80, 140}) {
    ASSERT_TRUE(wait_for_done(wanted));
    for (const pid_t mpirun : children_of(starter)) kill(mpirun, SIGKILL);
  }
  const auto end = wait(starter);
  EXPECT_EQ(end.code, 0) << end.err;
  EXPECT_THAT(end.err, Not(HasSubstr("is managed by process")));
  EXPECT_THAT(end.err, Not(HasSubstr("MPI_ABORT")));
  expect_each_case_completed_once(campaign, 400);
}

TEST_F(Killing, TheSecondSignalEndsARunWhoseRanksAreStopped) {
  submit(std::vector<std::string>(200, "good"), 0.05);
  const pid_t starter = start({"run", "--workers", "1"});
  ASSERT_TRUE(wait_for_done(5));
  for (const pid_t mpirun : children_of(starter)) {
    for (const pid_t rank : children_of(mpirun)) kill(rank, SIGSTOP);
    kill(mpirun, SIGSTOP);
  }
  kill(starter, SIGTERM);
  usleep(100000);
  kill(starter, SIGTERM);
  const auto end = wait(starter, 30);
  EXPECT_EQ(end.code, 75) << end.err;
  EXPECT_EQ(faultsweep({"run", "--workers", "2"}).code, 0);
}

TEST_F(Killing, AClosedTerminalStopsInOrderUnlessNohupWasAsked) {
  submit(std::vector<std::string>(300, "good"), 0.01);
  pid_t starter = start({"run", "--workers", "2"});
  ASSERT_TRUE(wait_for_done(20));
  kill(starter, SIGHUP);
  EXPECT_EQ(wait(starter).code, 75);
  starter = start({"run", "--workers", "2"}, [] { std::signal(SIGHUP, SIG_IGN); });
  ASSERT_TRUE(wait_for_done(150));
  kill(starter, SIGHUP);
  EXPECT_EQ(wait(starter).code, 0);
}

TEST_F(Killing, AfterEverythingWasKilledTheNextRunCompletesTheCampaign) {
  const std::int64_t campaign = submit(std::vector<std::string>(200, "good"), 0.01);
  const pid_t starter = start({"run", "--workers", "2"});
  ASSERT_TRUE(wait_for_done(20));
  for (const pid_t mpirun : children_of(starter)) {
    for (const pid_t rank : children_of(mpirun)) kill(rank, SIGKILL);
    kill(mpirun, SIGKILL);
  }
  kill(starter, SIGKILL);
  waitpid(starter, nullptr, 0);
  const auto end = faultsweep({"run", "--workers", "2"});
  EXPECT_EQ(end.code, 0) << end.err;
  expect_each_case_completed_once(campaign, 200);
}

TEST_F(Killing, CtrlCStopsInOrderAndRunContinues) {
  const std::int64_t campaign = submit(std::vector<std::string>(300, "good"), 0.01);
  const pid_t starter = start({"run", "--workers", "2"});
  ASSERT_TRUE(wait_for_done(20));
  kill(starter, SIGINT);
  const faultsim::Stopwatch watch;
  const auto stopped = wait(starter);
  EXPECT_LT(watch.seconds(), 8);
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("Next: faultsweep run sweep"));
  EXPECT_FALSE(Store::open_reader(store_).owner());
  const long done = Store::open_reader(store_).campaign("").n_done;
  EXPECT_LT(done, 300);
  EXPECT_EQ(faultsweep({"run", "--workers", "2"}).code, 0);
  expect_each_case_completed_once(campaign, 300);
}

/// Kills manager, workers and simulators in turn at pseudo-random moments; the final numbers are
/// those of an undisturbed campaign.
TEST_F(Killing, SlowThirtyKillsLeaveTheSameNumbers) {
  constexpr int kCases = 500, kKills = 30;
  submit(std::vector<std::string>(kCases, "good"));
  ASSERT_EQ(faultsweep({"run", "--workers", "2"}).code, 0);
  const std::string undisturbed = faultsweep({"rank", "--json", "--top", "0"}).out;
  std::filesystem::remove_all(store_);
  const std::int64_t campaign = submit(std::vector<std::string>(kCases, "good"), 0.25);
  unsigned state = 12345;
  const auto dice = [&](unsigned n) {
    state = state * 1664525u + 1013904223u;
    return (state >> 16) % n;
  };
  pid_t starter = start({"run", "--workers", "2"});
  int kills = 0, code = -1;
  while (code < 0 && kills < kKills) {
    // Between two kills some case is done: restarts without progress are given up, rightly.
    wait_for_done(Store::open_reader(store_).campaign("").n_done + 1);
    usleep(1000 * dice(700));
    int status = 0;
    if (waitpid(starter, &status, WNOHANG) == starter) {
      code = WEXITSTATUS(status);
      break;
    }
    std::vector<pid_t> targets;
    for (const pid_t mpirun : children_of(starter)) {
      for (const pid_t rank : children_of(mpirun)) {
        targets.push_back(rank);
        for (const pid_t simulator : children_of(rank)) targets.push_back(simulator);
      }
    }
    if (targets.empty()) continue;
    kill(targets[dice(static_cast<unsigned>(targets.size()))], SIGKILL);
    ++kills;
  }
  if (code < 0) code = wait(starter, 200).code;
  EXPECT_EQ(kills, kKills);
  // A killed simulator is a failed case: those are tried again by hand, as the policy says
  // `continue`.
  EXPECT_TRUE(code == 0 || code == 1) << code << text("err");
  faultsweep({"retry"});
  EXPECT_EQ(faultsweep({"run", "--workers", "2"}).code, 0);
  expect_each_case_completed_once(campaign, kCases);
  EXPECT_EQ(faultsweep({"rank", "--json", "--top", "0"}).out, undisturbed);
}

TEST_F(Killing, ASecondManagerIsRefused) {
  submit(std::vector<std::string>(200, "good"), 0.02);
  const pid_t starter = start({"run", "--workers", "1"});
  ASSERT_TRUE(wait_for_done(5));
  const auto first_out = folder_;
  const auto second = faultsweep({"run", "--workers", "1"});
  EXPECT_EQ(second.code, 4);
  EXPECT_THAT(second.err, HasSubstr("is managed by process"));
  kill(starter, SIGTERM);
  EXPECT_EQ(wait(starter).code, 75);
}

}  // namespace
}  // namespace faultsweep
