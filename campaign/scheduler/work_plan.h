#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/spec/spec.h"

namespace faultsweep {

/// A family whose cases wait.
struct FamilyWork {
  std::int64_t id = 0;
  std::string name;  ///< for people.
  std::vector<std::int64_t> cases;
  double operator_seconds = 0;  ///< predicted, when it has to be built.
  double case_seconds = 0;      ///< predicted or measured earlier; 0 = unknown.
  double memory_bytes = 0;      ///< predicted peak while the operator is built.
  bool operator_cached = false;
  /// Salt creeps: each worker on the family builds its operators for itself and holds them, and the
  /// memory, as long as it has cases of it. @pre not operator_cached.
  bool creeps = false;
};

/// Cases of one family for one worker.
struct Slice {
  int family = 0;  ///< index of the FamilyWork.
  std::vector<std::int64_t> cases;
  bool builds_operator = false;
};

/// Who runs what next: a pure state machine without processes or clocks.
///
/// Families are taken longest first, those whose operator is known before the others. One worker
/// builds a family's operator while others take other families; once it is there the family's cases
/// are shared out in slices that hold about kSliceSeconds of work, and less towards the end so that
/// all workers end together. Two operators are not built at once on one host unless both fit into
/// its memory; how much they take is predicted, and learned from those that were built.
///
/// The operators of a family whose salt creeps are one worker's own. Another worker joins it only
/// if a second set fits beside all that is held and being built, and if it pays: what waits keeps
/// each of those who are on it busy for longer than a build takes. Results do not depend on it.
class WorkPlan {
 public:
  struct Limits {
    int n_workers = 1;
    double memory_bytes = 0;  ///< of each host, for all that is built or held there together; 0 =
                              ///< not limited.
    FailureAction on_failure = FailureAction::proceed;
    int retries = 0;  ///< further attempts of a failed case, of FailureAction::retry.
  };
  WorkPlan(std::vector<FamilyWork> families, const Limits& limits);
  /// More work, also while there is some: cases of families that are known join those that wait,
  /// new families get indices behind those that there are.
  void add(std::vector<FamilyWork> families);

  /// Says where the worker runs: a number per host. Until then all are taken to share one.
  void place(int worker, int host) { at(worker).host = host; }
  /// Threads with which the worker may build its operator: the cores that cases on its host leave
  /// for at least half of the build, shared by those that build there or have a family to build. At
  /// least 1.
  int build_threads(int worker, int cores) const;
  /// What the worker (from 0) is to do in addition to what it has; nothing = have it wait.
  std::optional<Slice> next(int worker);

  /// The worker has the operator, or operators, of the family that it is on.
  /// @param peak_bytes  measured, of the process that built it; 0 = unknown.
  void operator_ready(int worker, double seconds, bool from_cache, double peak_bytes = 0);
  /// What an operator took that was predicted to take something else, also in an earlier run:
  /// families of its size are expected to do as badly as the worst of them, and kMemoryMargin more.
  void learn_memory(double predicted_bytes, double peak_bytes);
  void case_done(int worker, std::int64_t case_id, double seconds);
  /// A case failed. True if it is to be tried again (it waits again), false if that was final.
  /// @param in_operator  the operator was under way, the case itself had not started.
  bool case_failed(int worker, std::int64_t case_id, bool in_operator);
  /// Cases that a worker hands back untried.
  void returned(int worker, const std::vector<std::int64_t>& cases);
  /// True, once, when the operators that the worker holds are of no use any more: its simulator is
  /// to end. Their memory counts until released().
  bool take_release(int worker);
  void released(int worker);
  /// The cases that still wait in families whose operator cannot be built (it failed
  /// kOperatorAttempts times); they are to be recorded as failed, and are forgotten here.
  std::vector<std::int64_t> take_hopeless();
  /// From now on no failure stops it (FailureAction::abort): what follows is an extra.
  void go_on_after_failures() {
    if (limits_.on_failure == FailureAction::abort) limits_.on_failure = FailureAction::proceed;
  }
  /// Hands out nothing any more.
  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }

  /// Nothing under way, and nothing waits (or it is stopped).
  bool is_finished() const;
  int n_families() const { return static_cast<int>(families_.size()); }
  const FamilyWork& work(int index) const { return family(index).work; }  ///< without its cases.
  long n_waiting() const { return n_waiting_; }
  long n_in_flight() const { return static_cast<long>(in_flight_.size()); }
  long n_outstanding(int worker) const { return at(worker).n_cases; }
  /// Index of the family that the worker is on; -1 = none.
  int family_of(int worker) const { return at(worker).family; }
  bool is_building(int worker) const;
  /// Predicted for the operator that the worker builds, s; 0 where it builds none.
  double build_seconds_of(int worker) const;
  int family_index(std::int64_t case_id) const;  ///< of a case in flight.
  /// Predicted wall seconds until all is done, from what was measured so far, without what is left
  /// of operators that are being built.
  double seconds_left() const;

  static constexpr double kSliceSeconds =
      0.25;  ///< long against a message (~2 ms), short for a tail
  static constexpr double kLongCaseSeconds = 2;  ///< a message is nothing against it
  static constexpr int kLargestSlice = 256;      ///< bounds memory and what a kill may lose
  static constexpr int kOperatorAttempts = 2;  ///< a second try tells bad luck from a bad operator
  static constexpr double kMemoryMargin = 1.05;  ///< of what is learned from few operators

 private:
  enum class State { cold, building, ready };
  struct Family {
    FamilyWork work;
    std::deque<std::int64_t> waiting;
    State state = State::cold;  ///< where salt creeps: of the worker that is furthest.
    int n_workers = 0;
    int operator_failures = 0;
    bool alone = false;  ///< salt creeps, and a second set of operators could not be built.
    double measured_seconds = 0;  ///< of measured_cases cases.
    long measured_cases = 0;
  };
  struct Worker {
    int host = 0;
    int family = -1;
    long n_cases = 0;
    int holds = -1;  ///< the creeping family whose operators its simulator builds or has.
    bool has_operators = false;  ///< of that family.
    bool is_releasing = false;
  };
  struct Flight {
    int family = 0;
    int worker = 0;
  };

  Family& family(int index) { return families_[index]; }
  Worker& at(int worker) { return workers_[worker]; }
  const Worker& at(int worker) const { return workers_[worker]; }
  const Family& family(int index) const { return families_[index]; }
  double case_seconds(const Family& entry) const;
  double build_seconds(const Family& entry) const;
  double memory_bytes(const Family& entry) const;
  double total_seconds(const Family& entry) const;
  double busy_seconds(int index) const;
  bool has_operator(int worker, int index) const;
  int choose_family(int worker) const;
  int family_to_join(int worker) const;
  bool fits_in_memory(int worker, int index) const;
  bool pays_to_join(int index) const;
  void turn_to(int worker, int index);
  void let_go(Worker& worker);
  void update_state(int index);
  bool has_unclaimed_family() const;
  bool is_short_of_work(const Worker& worker) const;
  Slice cut(int worker, int index);
  void leave_family(Worker& worker);
  void landed(int worker, std::int64_t case_id);

  Limits limits_;
  std::vector<Family> families_;
  std::map<std::int64_t, int> by_id_;  ///< of families_.
  std::vector<int> order_;             ///< families by priority.
  std::vector<Worker> workers_;
  std::map<std::int64_t, Flight> in_flight_;
  std::map<std::int64_t, int> failures_;
  double predicted_operators_ = 0, measured_operators_ = 0;  ///< s, of those built.
  double learned_bytes_ = 0;  ///< predicted, of the largest operator whose memory was measured.
  double memory_ratio_ = 1;   ///< largest measured / predicted of operators of its size.
  long n_waiting_ = 0;        ///< over all families.
  bool stopped_ = false;
};

}  // namespace faultsweep
