#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "campaign/scheduler/progress.h"
#include "campaign/scheduler/wire.h"
#include "campaign/scheduler/work_plan.h"
#include "campaign/store/store.h"
#include "simulator/common/exit_code.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {

/// Rank 0: owns the store, hands out cases, commits what comes back. One campaign per life.
class Manager {
 public:
  struct Options {
    std::string campaign;     ///< "" = the newest.
    double memory_bytes = 0;  ///< for operators built and held together on a host; 0 = not limited.
    double patience = 10;     ///< s for cases under way once stopped.
    double lock_note_seconds = 10;  ///< until it is said that somebody has locked the store.
    std::function<bool()> is_stopped = {};  ///< asked while a locked store is waited for at first.
    std::optional<int> threads = {};  ///< of building an operator; none = WorkPlan::build_threads.
    /// RunOptions::next_round, asked when all cases are decided.
    std::function<bool(Store&, const std::string&)> next_round = {};
    /// RunOptions::shown_first, asked once, when no further round comes.
    std::function<std::vector<std::int64_t>(const Store&, const CampaignInfo&)> shown_first = {};
  };
  /// Claims the store. Throws StorageError. Where another process has locked the store, this and
  /// all below wait for it, however long: nothing that came is lost.
  Manager(Store& store, Link& link, ProgressDisplay& display, const Options& options);
  ~Manager();
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  /// One turn: messages, work, commits, heartbeat. False when all is over and the workers may quit.
  /// Throws StorageError where another manager has taken the store.
  bool turn();
  bool is_busy() const { return busy_; }
  /// Hands out nothing any more; cases under way are waited for, at most `patience` seconds.
  void interrupt();
  /// Commits what has arrived: in each turn, and when the job is torn down. False, keeping all that
  /// is left, while another process has locked the store for kLockSeconds.
  bool commit();
  /// How the campaign stands: done, incomplete, interrupted, world (a worker was in trouble).
  faultsim::ExitCode status() const;
  const std::string& trouble() const { return trouble_; }
  /// All workers have handed back what they had; otherwise they cannot be told to quit in order.
  bool workers_are_drained() const { return n_drained_ == n_workers(); }

  static constexpr double kCommitSeconds = 0.05;   ///< the oldest result waits no longer
  static constexpr std::size_t kCommitRuns = 512;  ///< nor are more together in one transaction
  static constexpr int kFailuresShown = 10;        ///< each in a line; the store has all.
  static constexpr double kLockSeconds = 0.1;      ///< how long a turn waits for a locked store
  /// Results in memory, while the store is locked, from which on no more cases are handed out.
  static constexpr std::size_t kMostUncommitted = 5000;

 private:
  int n_workers() const { return link_.size() - 1; }
  /// Where all workers are, and with how many cores: who builds with which threads depends on it.
  bool knows_all_hosts() const { return n_greeted_ == n_workers(); }
  void tell(int worker, const Message& message) { link_.send(worker + 1, message); }  ///< from 0.
  void greet(int worker, const message::Hello& hello);
  void handle(int worker, JobEvents events);
  void handle_result(int worker, JobEvents::Completed completed);
  /// A run for fields only must repeat the stored result bit for bit: the fields are those of that
  /// result or they are removed. With the same operator a difference is our bug, with another one
  /// (another BLAS kernel, hence other last bits) the world's doing. Nothing = they are kept.
  std::optional<JobEvents::Failure> refuse_fields(const RunRecord& run);
  void handle_failure(int worker, const JobEvents::Failure& failure);
  void show_failure(const std::string& text);
  void hand_out();
  void send_work(int worker, const Slice& slice);
  void add_run(RunRecord run);
  void fail_hopeless();
  void take_work();
  bool take_requeued();
  bool take_next_round();
  bool take_shown_fields();
  std::vector<std::int64_t> cases_shown_first();
  /// The run adds fields to a case that counts as done without them.
  bool is_extra(std::int64_t case_id) const {
    return campaign_.keep_fields == KeepFields::shown && fields_only_.contains(case_id);
  }
  void begin_drain();
  enum class Access { reads, writes };
  /// False where another process has locked the store: then nothing was written. Only what writes
  /// tells that it is free again.
  bool try_store(const std::function<void()>& work, Access access = Access::writes);
  /// The same until the store is free.
  void insist(const std::function<void()>& work, Access access = Access::writes);
  void note_lock();
  void note_event(const std::string& kind, const std::string& text);  ///< for the next commit.
  void beat();
  double seconds_left() const;
  std::string what_is_built(int n_building) const;
  std::string progress_json() const;

  Store& store_;
  Link& link_;
  ProgressDisplay& display_;
  Options options_;
  CampaignInfo campaign_;      ///< counts: what has arrived included.
  std::string fields_folder_;  ///< of the campaign, absolute.
  std::unique_ptr<WorkPlan> plan_;
  std::map<std::int64_t, long> positions_;  ///< of cases under way
  std::set<std::int64_t> fields_only_;      ///< cases that have a result and lack their fields
  std::vector<std::set<std::int64_t>> scenes_sent_;
  std::vector<std::string> hosts_;
  std::vector<int> cores_;
  std::vector<faultsim::Stopwatch> since_build_;  ///< by worker, of what it builds now.
  std::vector<std::string> building_;  ///< by worker, what it does for it; "" = not told.
  std::map<std::string, int> host_numbers_;
  std::vector<RunRecord> uncommitted_;
  std::deque<std::pair<int, OperatorRecord>> operators_;
  std::deque<std::pair<std::string, std::string>> events_;  ///< kind and text; not committed.
  faultsim::Stopwatch since_first_uncommitted_, since_beat_, since_look_, since_start_,
      since_drain_, since_lock_note_;
  long n_incomplete_ = 0, n_finished_now_ = 0;
  long n_failures_shown_ = 0;
  long n_extras_left_ = 0;  ///< cases that lack no more than the fields of those shown first.
  int n_greeted_ = 0, n_drained_ = 0;
  bool chose_fields_ = false;  ///< of the cases shown first: nothing comes after them.
  bool busy_ = false, interrupted_ = false, draining_ = false, aborted_ = false, cancelled_ = false;
  bool locked_ = false, lock_is_noted_ = false;  ///< the store, by another process.
  std::string trouble_;
};

}  // namespace faultsweep
