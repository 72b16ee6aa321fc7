#include "campaign/scheduler/manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <deque>
#include <fstream>
#include <set>

#include "campaign/scheduler/worker.h"
#include "campaign/store/sqlite.h"
#include "simulator/common/stopwatch.h"
#include "simulator/result/result_bytes.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {
namespace {

using faultsim::ExitCode;

/// Decides each job by its title, at once; one job per call of work().
class FakeRunner final : public JobRunner {
 public:
  void begin_family(const FamilyTask&) override { has_operator_ = false; }
  void end_family() override { has_operator_ = false; }
  void hold(std::int64_t base, const std::string& scene) override { bases_[base] = scene; }
  void add(Job job) override { jobs_.push_back(std::move(job)); }
  bool is_idle() const override { return jobs_.empty(); }
  void drain() override { draining_ = true; }
  JobEvents work(int) override {
    JobEvents events;
    if (draining_) {
      for (const Job& job : jobs_) events.returned.push_back(job.case_id);
      jobs_.clear();
    }
    if (jobs_.empty()) return events;
    if (builds_until_it_may_end && !has_operator_) {
      events.building = "operator 3 of a surface: meshing";
      return events;
    }
    const Job job = jobs_.front();
    jobs_.pop_front();
    RunRecord run;
    run.case_id = job.case_id;
    run.wall_seconds = 0.001;
    if ((bases_.at(job.base) + job.changes).find("crash") != std::string::npos) {
      run.reason = "killed";
      events.failed.push_back({run, false});
      return events;
    }
    if (!has_operator_) events.operators.push_back({"print", false, 1, 1, 1, 1, 1});
    has_operator_ = true;
    run.status = RunStatus::completed;
    faultsim::CaseResult result = testing::made_up_result(strength, 3);
    result.outcome = outcome;
    result.operator_fingerprint = operator_fingerprint;
    run.has_fields = !job.fields_folder.empty();
    fields_folders.insert(job.fields_folder);
    if (run.has_fields) fields_steps.insert(job.keep_fields);
    ++n_runs;
    if (run.has_fields && fields_fail) {
      run.status = RunStatus::world;
      run.reason = "disk full";
      run.has_fields = false;
      events.failed.push_back({run, false});
      return events;
    }
    events.completed.push_back({std::move(run), faultsim::result_to_bytes(result)});
    if (damage) events.completed.back().result[70] ^= 1;
    return events;
  }
  static inline bool builds_until_it_may_end = false;
  static inline int n_runs = 0;
  static inline double strength = 0.7;
  static inline bool damage = false;  ///< of results, on their way.
  static inline faultsim::Outcome outcome = faultsim::Outcome::converged;
  static inline std::string operator_fingerprint = "print";
  static inline std::set<std::string> fields_folders;
  static inline std::set<KeepFields> fields_steps;
  static inline bool fields_fail = false;

 private:
  std::map<std::int64_t, std::string> bases_;
  std::deque<Job> jobs_;
  bool has_operator_ = false, draining_ = false;
};

/// Manager and workers in one process, taking turns; messages are encoded on the way.
class Stage final : public Link {
 public:
  class End final : public Link {
   public:
    End(Stage& stage, int rank) : stage_(stage), rank_(rank) {}
    int size() const override { return stage_.size(); }
    void send(int, const Message& message) override {
      stage_.to_manager_.push_back({rank_, encode(message)});
    }
    std::optional<Received> receive() override {
      if (inbox.empty()) return std::nullopt;
      const std::string bytes = inbox.front();
      inbox.pop_front();
      return Received{0, decode(bytes)};
    }
    std::deque<std::string> inbox;

   private:
    Stage& stage_;
    int rank_;
  };

  explicit Stage(int n) {
    for (int k = 0; k < n; ++k) {
      ends_.push_back(std::make_unique<End>(*this, k + 1));
      runners_.push_back(std::make_unique<FakeRunner>());
      workers_.push_back(std::make_unique<Worker>(*ends_.back(), *runners_.back()));
    }
  }
  int size() const override { return static_cast<int>(ends_.size()) + 1; }
  void send(int to, const Message& message) override {
    ends_[static_cast<std::size_t>(to - 1)]->inbox.push_back(encode(message));
  }
  std::optional<Received> receive() override {
    if (to_manager_.empty()) return std::nullopt;
    auto [from, bytes] = to_manager_.front();
    to_manager_.pop_front();
    return Received{from, decode(bytes)};
  }
  /// Until the manager is done, at most n_turns; true if it is.
  bool play(Manager& manager, int n_turns = 1000000) {
    for (int turn = 0; turn < n_turns; ++turn) {
      if (!manager.turn()) return true;
      for (const auto& worker : workers_) worker->turn(0);
    }
    return false;
  }

 private:
  std::vector<std::unique_ptr<End>> ends_;
  std::vector<std::unique_ptr<FakeRunner>> runners_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::deque<std::pair<int, std::string>> to_manager_;
};

class ManagerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "manager_XXXXXX";
    folder_ = mkdtemp(name.data());
    FakeRunner::n_runs = 0;
    FakeRunner::builds_until_it_may_end = false;
    FakeRunner::outcome = faultsim::Outcome::converged;
    FakeRunner::strength = 0.7;
    FakeRunner::operator_fingerprint = "print";
    FakeRunner::fields_folders.clear();
    FakeRunner::fields_steps.clear();
    FakeRunner::fields_fail = false;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void submit(int n, const std::vector<int>& crashing, Policy policy = {},
              const std::string& name = "sweep", KeepFields keep = KeepFields::none) {
    Submission s;
    s.name = name;
    s.keep_fields = keep;
    s.parameters = {};
    s.policy = policy;
    s.scenes = {{"scene.json", "{\"title\": \"base\"}"}};
    s.families = {{"a", 1, 1, 2, 1}, {"b", 1, 1, 1, 1}, {"c", 1, 1, 1, 1}};
    for (int k = 0; k < n; ++k) {
      const bool crashes = std::count(crashing.begin(), crashing.end(), k) > 0;
      s.cases.push_back(
          {"case-" + std::to_string(k), k % 3, 0, crashes ? R"({"/title": "crash"})" : "{}", {}});
    }
    Store::open_writer(folder_).submit(s);
  }

  /// Runs the newest campaign, of which these cases are shown first; how it ended.
  ExitCode run_shown(const std::vector<std::int64_t>& first, int n_turns = 1000000) {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    const auto shown_first = [&](const Store& s, const CampaignInfo& info) {
      EXPECT_EQ(s.campaign(info.name).n_waiting, 0) << "it is known only when all are decided";
      ++n_asked_;
      return first;
    };
    Manager manager(store, stage, silent_, {.campaign = "", .shown_first = shown_first});
    const bool ended = stage.play(manager, n_turns);
    EXPECT_TRUE(ended || n_turns < 1000);
    return manager.status();
  }
  void write_fields(const std::string& campaign, int position) const {
    const auto folder = folder_ / "fields" / campaign / std::to_string(position);
    std::filesystem::create_directories(folder);
    for (const char* file : {"faults.h5", "faults.xmf"}) std::ofstream(folder / file) << "x";
  }
  std::string events() const {
    const Store store = Store::open_reader(folder_);
    std::string text;
    for (const EventRecord& event : store.events(store.campaign("").id, 100))
      text = event.kind + ": " + event.text + "\n" + text;
    return text;
  }
  /// Runs the newest campaign; how it ended.
  ExitCode run() {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {});
    EXPECT_TRUE(stage.play(manager));
    return manager.status();
  }
  /// Twelve cases that were run without fields, and a campaign that wants the fields of them.
  void submit_for_fields(Policy policy = {}) {
    submit(12, {});
    EXPECT_EQ(run(), ExitCode::done);
    submit(12, {}, policy, "fields", KeepFields::stages);
  }

  int n_asked_ = 0;  ///< which cases are shown first.
  std::filesystem::path folder_;
  ProgressDisplay silent_{ProgressDisplay::Style::silent};
};

TEST_F(ManagerTest, RunsEveryCaseOnceAndASecondRunDoesNothing) {
  submit(200, {});
  for (int repeat = 0; repeat < 2; ++repeat) {
    Store store = Store::open_owner(folder_);
    Stage stage(3);
    Manager manager(store, stage, silent_, {});
    EXPECT_TRUE(stage.play(manager));
    EXPECT_EQ(manager.status(), ExitCode::done);
    EXPECT_EQ(store.campaign("").n_converged, 200);
    EXPECT_EQ(FakeRunner::n_runs, 200);
  }
}

/// `status` reads it in the store, which hears of it once a second.
TEST_F(ManagerTest, SaysWhatIsBeingBuilt) {
  submit(3, {});
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Manager manager(store, stage, silent_, {});
  FakeRunner::builds_until_it_may_end = true;
  const auto is_said = [&] {
    const auto owner = store.owner();
    return owner &&
           owner->progress.find("building: operator 3 of a surface: meshing") != std::string::npos;
  };
  const faultsim::Stopwatch watch;
  while (!is_said() && watch.seconds() < 20) EXPECT_FALSE(stage.play(manager, 10));
  EXPECT_TRUE(is_said());
  FakeRunner::builds_until_it_may_end = false;
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::done);
}

TEST_F(ManagerTest, FailuresAreRowsAndTheCampaignIsIncomplete) {
  submit(30, {3, 17});
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_done, 28);
  EXPECT_EQ(info.n_failed, 2);
  EXPECT_EQ(store.stored_case(info.id, "4").runs.at(0).reason, "killed");
}

TEST_F(ManagerTest, ADamagedResultIsARowWithItsReason) {
  submit(3, {});
  FakeRunner::damage = true;
  EXPECT_EQ(run(), ExitCode::incomplete);
  FakeRunner::damage = false;
  const Store store = Store::open_reader(folder_);
  const StoredRun one = store.stored_case(store.campaign("").id, "2").runs.at(0);
  EXPECT_EQ(one.status, "garbled");
  EXPECT_THAT(one.reason, ::testing::HasSubstr("its checksum differs"));
}

TEST_F(ManagerTest, SlipEventsAreFullResultsAndEarlyEndsAreNot) {
  using faultsim::Outcome;
  submit(4, {});
  const std::pair<Outcome, ExitCode> expected[] = {{Outcome::unstable, ExitCode::incomplete},
                                                   {Outcome::unresolved_event, ExitCode::done},
                                                   {Outcome::event, ExitCode::done}};
  for (const auto& [outcome, status] : expected) {
    FakeRunner::outcome = outcome;
    Store store = Store::open_owner(folder_);
    for (int repeat = 0; repeat < 2; ++repeat) {  // as it comes, and as the store counts it
      Stage stage(1);
      Manager manager(store, stage, silent_, {});
      EXPECT_TRUE(stage.play(manager));
      EXPECT_EQ(manager.status(), status) << faultsim::to_string(outcome) << repeat;
    }
    // The next outcome takes its place.
    Connection connection(folder_ / "campaign.sqlite", Connection::Mode::read_write);
    connection.execute("UPDATE cases SET state = 'waiting'");
  }
}

TEST_F(ManagerTest, RetriesAsTheSpecSays) {
  Policy policy;
  policy.on_failure = FailureAction::retry;
  policy.retries = 2;
  submit(10, {5}, policy);
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(store.stored_case(store.campaign("").id, "6").runs.size(), 3u);
}

TEST_F(ManagerTest, AbortLeavesTheRestWaiting) {
  Policy policy;
  policy.on_failure = FailureAction::abort;
  submit(300, {0}, policy);
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  EXPECT_EQ(store.campaign("").n_failed, 1);
  EXPECT_GT(store.campaign("").n_waiting, 200);
}

TEST_F(ManagerTest, InterruptedCampaignsResumeWhereTheyStopped) {
  submit(100, {});
  {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {});
    EXPECT_FALSE(stage.play(manager, 20));
    manager.interrupt();
    EXPECT_TRUE(stage.play(manager));
    EXPECT_TRUE(manager.workers_are_drained());
    EXPECT_EQ(manager.status(), ExitCode::interrupted);
    EXPECT_GT(store.campaign("").n_done, 0);
    EXPECT_EQ(store.campaign("").n_done, FakeRunner::n_runs);
  }
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 100);
}

/// Forgets manager and workers after each number of turns, as kill -9 of all of them would.
TEST_F(ManagerTest, KilledAtAnyTurnTheNextManagerCompletesTheCampaign) {
  submit(25, {7});
  for (int turns = 0; turns < 60; turns += 3) {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {});
    stage.play(manager, turns);
    EXPECT_TRUE(store.integrity_problems().empty());
  }
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_, {});
  EXPECT_TRUE(stage.play(manager));
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_done, 24);
  EXPECT_EQ(info.n_failed, 1);
  for (int position = 1; position <= 25; ++position) {
    EXPECT_EQ(store.stored_case(info.id, std::to_string(position)).runs.size(), 1u);
  }
}

/// Rounds of three cases, by their number; case-5 crashes. The third proposal is the end.
bool next_round_of_three(Store& store, const std::string& name, std::vector<long>& asked_with) {
  const CampaignInfo info = store.campaign(name);
  EXPECT_EQ(info.n_waiting, 0) << "asked before all cases were decided";
  const auto n_rounds = static_cast<int>(store.rounds(info.id).size());
  asked_with.push_back(info.n_failed);
  if (n_rounds == 3) {
    store.conclude(info.id, "enough");
    return false;
  }
  Submission s;
  s.parameters = {};
  s.scenes = {{"scene.json", "{\"title\": \"base\"}"}};
  s.families = {{"a", 1, 1, 2, 1}, {"d", 1, 1, 1, 1}};         // one is known, one is new
  for (int k = 3 * n_rounds - 1; k < 3 * n_rounds + 3; ++k) {  // the first is of the round before
    s.cases.push_back(
        {"case-" + std::to_string(k), k % 2, 0, k == 5 ? R"({"/title": "crash"})" : "{}", {}});
  }
  EXPECT_EQ(store.record_round(info.id, s, R"({"round": "design"})", "more"), 3);
  return true;
}

TEST_F(ManagerTest, GoesOnRoundByRoundUntilThereIsNoFurtherOne) {
  submit(3, {});
  std::vector<long> asked_with;
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_,
                  {.campaign = "", .next_round = [&](Store& s, const std::string& name) {
                     return next_round_of_three(s, name, asked_with);
                   }});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_EQ(manager.status(), ExitCode::incomplete);
  EXPECT_THAT(asked_with, ::testing::ElementsAre(0, 1, 1)) << "a failed case is told";
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_cases, 9);
  EXPECT_EQ(info.n_done, 8);
  EXPECT_EQ(info.conclusion, "enough");
  const auto rounds = store.rounds(info.id);
  ASSERT_EQ(rounds.size(), 3u);
  EXPECT_EQ(rounds[2].first_position, 7);
  EXPECT_EQ(rounds[2].n_cases, 3) << "a case of an earlier round is not a case of a later one";
  EXPECT_EQ(rounds[2].reason, "more");
  EXPECT_TRUE(store.integrity_problems().empty());
  EXPECT_TRUE(store
                  .submit([] {
                    Submission s;
                    s.name = "sweep";
                    s.parameters = {};
                    s.scenes = {{"scene.json", "{\"title\": \"base\"}"}};
                    s.families = {{"a", 1, 1, 2, 1}};
                    for (int k = 0; k < 3; ++k)
                      s.cases.push_back({"case-" + std::to_string(k), 0, 0, "{}", {}});
                    return s;
                  }())
                  .existed)
      << "it is known by its first round";
}

/// As above, killed after each number of turns: each round is proposed once, each case run once.
TEST_F(ManagerTest, KilledAtAnyTurnRoundsGoOnWhereTheyWere) {
  submit(3, {});
  std::vector<long> asked_with;
  const auto next_round = [&](Store& s, const std::string& name) {
    return next_round_of_three(s, name, asked_with);
  };
  for (int turns = 0; turns < 40; ++turns) {
    Store store = Store::open_owner(folder_);
    Stage stage(2);
    Manager manager(store, stage, silent_, {.campaign = "", .next_round = next_round});
    stage.play(manager, turns);
    EXPECT_TRUE(store.integrity_problems().empty());
  }
  Store store = Store::open_reader(folder_);
  const CampaignInfo info = store.campaign("");
  EXPECT_EQ(info.n_cases, 9);
  EXPECT_EQ(info.n_done, 8);
  EXPECT_EQ(store.rounds(info.id).size(), 3u);
  for (int position = 1; position <= 9; ++position) {
    EXPECT_EQ(store.stored_case(info.id, std::to_string(position)).runs.size(), 1u);
  }
}

TEST_F(ManagerTest, AStoppedCampaignIsNotAskedForItsNextRound) {
  Policy policy;
  policy.on_failure = FailureAction::abort;
  submit(3, {1}, policy);
  std::vector<long> asked_with;
  Store store = Store::open_owner(folder_);
  Stage stage(1);
  Manager manager(store, stage, silent_,
                  {.campaign = "", .next_round = [&](Store& s, const std::string& name) {
                     return next_round_of_three(s, name, asked_with);
                   }});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_THAT(asked_with, ::testing::IsEmpty());
}

TEST_F(ManagerTest, TellsWhereTheFieldsOfEachCaseGo) {
  submit(3, {}, {}, "sweep", KeepFields::all);
  EXPECT_EQ(run(), ExitCode::done);
  const std::string folder = folder_ / "fields" / "sweep";
  EXPECT_EQ(FakeRunner::fields_folders,
            (std::set<std::string>{folder + "/1", folder + "/2", folder + "/3"}));
}

TEST_F(ManagerTest, AddsFieldsToStoredResults) {
  submit_for_fields();
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 24);
  Store store = Store::open_reader(folder_);
  const CampaignInfo info = store.campaign("fields");
  EXPECT_EQ(info.n_done, 12);
  for (int position = 1; position <= 12; ++position) {
    const StoredCase stored = store.stored_case(info.id, std::to_string(position));
    EXPECT_EQ(stored.fields, FieldsState::kept);
    ASSERT_EQ(stored.runs.size(), 2u);
    EXPECT_FALSE(stored.runs[0].fields_only);
    EXPECT_TRUE(stored.runs[1].fields_only);
  }
}

TEST_F(ManagerTest, WritesLostFieldsAgain) {
  submit(3, {}, {}, "sweep", KeepFields::all);
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 3);  // the fake writes no files, so they count as lost
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 6);
  for (int position = 1; position <= 3; ++position) {
    write_fields("sweep", position);
  }
  EXPECT_EQ(run(), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 6);
}

/// As the fake writes no files, they count as lost unless the test does.
TEST_F(ManagerTest, WritesTheFieldsOfTheCasesShownFirstWhenAllAreDecided) {
  submit(12, {}, {}, "sweep", KeepFields::shown);
  EXPECT_EQ(run_shown({5, 2, 9}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 15);
  EXPECT_EQ(FakeRunner::fields_steps, std::set<KeepFields>{KeepFields::stages});
  std::set<std::string> folders = {""};  // cases run without
  Store store = Store::open_reader(folder_);
  const CampaignInfo info = store.campaign("");
  for (const std::int64_t id : {5, 2, 9}) {
    const long position = store.decided_case(info.id, id).position;
    folders.insert(store.fields_folder("sweep", position));
    const StoredCase stored = store.stored_case(info.id, std::to_string(position));
    EXPECT_EQ(stored.fields, FieldsState::kept);
    ASSERT_EQ(stored.runs.size(), 2u);
    EXPECT_TRUE(stored.runs[1].fields_only);
  }
  EXPECT_EQ(FakeRunner::fields_folders, folders);
  EXPECT_EQ(info.n_done, 12);
  EXPECT_EQ(info.n_fields_kept, 3);
  EXPECT_THAT(events(), ::testing::HasSubstr("fields: all is decided; the fault fields of the "
                                             "cases ranked first follow: 5, 2, 9\n"));
  EXPECT_TRUE(store.integrity_problems().empty());
}

TEST_F(ManagerTest, ASecondRunWritesMissingFieldsOfCasesShownFirstOnly) {
  submit(6, {}, {}, "sweep", KeepFields::shown);
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  for (const int position : {1, 2, 3}) write_fields("sweep", position);
  FakeRunner::n_runs = 0;
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 0);
  EXPECT_EQ(run_shown({4, 2, 3}), ExitCode::done) << "the order is another since";
  EXPECT_EQ(FakeRunner::n_runs, 1);
  EXPECT_EQ(Store::open_reader(folder_).campaign("").n_fields_kept, 4) << "those of 1 stay";
  std::filesystem::remove_all(folder_ / "fields" / "sweep" / "1");
  write_fields("sweep", 4);
  EXPECT_EQ(run_shown({4, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 1) << "nobody looks at 1 any more";
}

/// With `abort` too: what is decided is not undone by an extra.
TEST_F(ManagerTest, FieldsOfCasesShownFirstThatFailAreNoFailureOfTheCampaign) {
  Policy policy;
  policy.on_failure = FailureAction::abort;
  submit(6, {}, policy, "sweep", KeepFields::shown);
  FakeRunner::fields_fail = true;
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 9) << "all three were tried";
  const CampaignInfo info = Store::open_reader(folder_).campaign("");
  EXPECT_EQ(info.n_done, 6);
  EXPECT_EQ(info.n_failed, 0);
  EXPECT_EQ(info.n_fields_failed, 3);
  EXPECT_THAT(events(), ::testing::HasSubstr("case failed: fields of case 1 world: disk full"));
  EXPECT_THAT(events(), ::testing::Not(::testing::HasSubstr("aborted")));
  FakeRunner::n_runs = 0;
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(FakeRunner::n_runs, 0) << "they wait for retry";
  FakeRunner::fields_fail = false;
  EXPECT_EQ(Store::open_owner(folder_).retry(info.id, false, std::nullopt), 3);
  EXPECT_EQ(run_shown({1, 2, 3}), ExitCode::done);
  EXPECT_EQ(Store::open_reader(folder_).campaign("").n_fields_kept, 3);
}

TEST_F(ManagerTest, KilledAtAnyTurnFieldsOfCasesShownFirstComeInTheEnd) {
  submit(6, {1}, {}, "sweep", KeepFields::shown);
  for (int turns = 0; turns < 40; ++turns) {
    run_shown({1, 3, 4}, turns);
    const Store store = Store::open_reader(folder_);
    for (const int position : {1, 3, 4}) {
      const auto fields = store.stored_case(1, std::to_string(position)).fields;
      if (fields == FieldsState::kept) write_fields("sweep", position);
    }
    EXPECT_TRUE(store.integrity_problems().empty());
  }
  const CampaignInfo info = Store::open_reader(folder_).campaign("");
  EXPECT_EQ(info.n_done, 5);
  EXPECT_EQ(info.n_failed, 1);
  EXPECT_EQ(info.n_fields_kept, 3);
  const Store store = Store::open_reader(folder_);
  for (int position = 1; position <= 6; ++position) {
    const bool shown = position == 1 || position == 3 || position == 4;
    EXPECT_EQ(store.stored_case(1, std::to_string(position)).runs.size(), shown ? 2u : 1u);
  }
}

TEST_F(ManagerTest, AsksForCasesShownFirstAfterTheLastRoundAndOnlyWhereTheirFieldsAreKept) {
  for (const KeepFields keep : {KeepFields::none, KeepFields::stages}) {
    submit(3, {}, {}, to_string(keep), keep);
    EXPECT_EQ(run_shown({1}), ExitCode::done);
  }
  EXPECT_EQ(n_asked_, 0);
  submit(3, {}, {}, "sweep", KeepFields::shown);
  std::vector<long> asked_with;
  Store store = Store::open_owner(folder_);
  Stage stage(2);
  Manager manager(store, stage, silent_,
                  {.campaign = "sweep",
                   .next_round =
                       [&](Store& s, const std::string& name) {
                         return next_round_of_three(s, name, asked_with);
                       },
                   .shown_first =
                       [&](const Store& s, const CampaignInfo& info) {
                         EXPECT_EQ(s.campaign(info.name).conclusion, "enough");
                         return std::vector<std::int64_t>{1};
                       }});
  EXPECT_TRUE(stage.play(manager));
  EXPECT_THAT(asked_with, ::testing::ElementsAre(0, 1, 1)) << "not again after the fields";
  EXPECT_EQ(store.campaign("sweep").n_fields_kept, 1);
}

/// With the same operator another number is a bug, with another operator the world's doing; either
/// way the fields do not stay and the stored result does.
TEST_F(ManagerTest, RefusesFieldsOfOtherNumbers) {
  for (const char* fingerprint : {"print", "other"}) {
    std::filesystem::remove_all(folder_);
    FakeRunner::strength = 0.7;
    FakeRunner::operator_fingerprint = "print";
    submit_for_fields();
    FakeRunner::strength = std::nextafter(0.7, 1.0);
    FakeRunner::operator_fingerprint = fingerprint;
    std::filesystem::create_directories(folder_ / "fields" / "fields" / "5");
    EXPECT_EQ(run(), ExitCode::incomplete);
    Store store = Store::open_reader(folder_);
    const CampaignInfo info = store.campaign("fields");
    EXPECT_EQ(info.n_failed, 12);
    EXPECT_EQ(info.n_fields_failed, 12);
    const StoredCase stored = store.stored_case(info.id, "5");
    EXPECT_EQ(stored.fields, FieldsState::failed);
    EXPECT_EQ(stored.result.whole.chi_bar, 0.7);
    const bool same = std::string(fingerprint) == "print";
    EXPECT_EQ(stored.runs.at(1).status, same ? "bug" : "world");
    EXPECT_EQ(stored.runs.at(1).reason,
              "the fields are not those of the stored result, from which this run differs in load "
              "step 1 (primary_production)" +
                  std::string(same ? ", with the same operator"
                                   : ": it used the operator other, the stored one comes from "
                                     "print"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "fields" / "fields" / "5"));
  }
}

TEST_F(ManagerTest, RetriesRunsForFieldsAsTheSpecSays) {
  Policy policy;
  policy.on_failure = FailureAction::retry;
  policy.retries = 1;
  submit_for_fields(policy);
  FakeRunner::strength = 0.8;
  EXPECT_EQ(run(), ExitCode::incomplete);
  Store store = Store::open_reader(folder_);
  EXPECT_EQ(store.stored_case(store.campaign("fields").id, "3").runs.size(), 3u);
}

}  // namespace
}  // namespace faultsweep
