#pragma once

#include <deque>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "campaign/scheduler/job_runner.h"
#include "campaign/scheduler/simulator_process.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {

/// A JobRunner with one simulator process per family, kept while the family lasts.
///
/// The case in flight is the one that the process said `started` last. When the process dies, hangs
/// or talks garbage, that case has failed; the others of the family go to a new process. Where no
/// case had started, the operator has failed: the first case carries the blame, the others are
/// returned, for whoever decides whether the operator is worth another try.
class LocalRunner final : public JobRunner {
 public:
  struct Options {
    SimulatorProcess::Options process;
    std::string host;
    int rank = 0;
  };
  explicit LocalRunner(Options options) : options_(std::move(options)) {}

  void begin_family(const FamilyTask& task) override;
  void end_family() override;
  void hold(std::int64_t base, const std::string& scene) override;
  void add(Job job) override;
  JobEvents work(int timeout_ms) override;
  void drain() override;
  bool is_idle() const override { return jobs_.empty(); }

  /// Unless the campaign says so, what a process may take until it has its operator, also where
  /// cases have no time limit: at least this, s, ...
  static constexpr double kOperatorLeast = 600;
  /// ... or so many times the prediction, which is from another machine.
  static constexpr double kOperatorFactor = 20;
  /// Time for a process to end by itself after it has closed its replies, s.
  static constexpr double kEndGrace = 5;

 private:
  void start();
  void send(const Job& job);
  void handle(const std::string& line, JobEvents& events);
  void handle_done(const nlohmann::json& reply, std::string result, JobEvents& events);
  /// The next reply, or the result that the last one announced, is handled; false = not there yet.
  bool handle_next(JobEvents& events);
  void process_failed(RunStatus status, std::string reason, const ProcessEnd& end,
                      JobEvents& events);
  void process_ended(JobEvents& events);
  /// Of the present phase: the operator, or a case; none = not limited, or nothing is under way.
  std::optional<double> time_limit() const;
  std::string under_limit() const;
  RunRecord blank_run(std::int64_t case_id) const;

  Options options_;
  FamilyTask task_;
  std::unique_ptr<SimulatorProcess> process_;
  std::deque<Job> jobs_;  ///< in the order sent; the first is in flight or next.
  std::map<std::int64_t, std::string> bases_;
  std::set<std::int64_t> bases_sent_;     ///< to the present process.
  std::optional<nlohmann::json> result_;  ///< the reply whose result is to follow.
  bool greeted_ = false;                  ///< the present process said hello.
  bool operator_known_ = false;           ///< the present process has its operator.
  bool started_ = false;                  ///< jobs_.front() has started.
  bool draining_ = false;
  double operator_seconds_ = 0;  ///< of the operator made for jobs_.front().
  faultsim::Stopwatch since_;    ///< of the present phase: start-up and operator, or a case.
};

}  // namespace faultsweep
