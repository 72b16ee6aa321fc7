#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <memory>
#include <set>

#include "campaign/scheduler/manager.h"
#include "campaign/scheduler/worker.h"
#include "campaign/store/sqlite.h"
#include "simulator/result/result_bytes.h"
#include "tests/campaign/made_up_result.h"

namespace faultsweep {

using faultsim::ExitCode;

/// Decides each job by its title, at once; one job per call of work().
class FakeRunner final : public JobRunner {
 public:
  void begin_family(const FamilyTask& task) override {
    has_operator_ = false;
    threads.push_back(task.threads);
  }
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
  static inline std::vector<int> threads;  ///< of each family that was begun.
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
  /// The worker (from 0) says where it is, on a host of four cores.
  void greet(std::size_t worker) {
    ends_[worker]->send(0, message::Hello{"host", 4});
    greeted_.insert(worker);
  }
  /// Until the manager is done, at most n_turns; true if it is. Who has not greeted does so first.
  bool play(Manager& manager, int n_turns = 1000000) {
    for (std::size_t worker = 0; worker < workers_.size(); ++worker)
      if (!greeted_.contains(worker)) greet(worker);
    return take_turns(manager, n_turns);
  }
  bool take_turns(Manager& manager, int n_turns) {
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
  std::set<std::size_t> greeted_;
};

class ManagerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = ::testing::TempDir() + "manager_XXXXXX";
    folder_ = mkdtemp(name.data());
    FakeRunner::n_runs = 0;
    FakeRunner::threads.clear();
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

/// Rounds of three cases, by their number; case-5 crashes. The third proposal is the end.
inline bool next_round_of_three(Store& store, const std::string& name,
                                std::vector<long>& asked_with) {
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

}  // namespace faultsweep
