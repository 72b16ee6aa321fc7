#pragma once

#include <functional>
#include <map>
#include <string>

#include "campaign/scheduler/job_runner.h"
#include "campaign/scheduler/wire.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {

/// A rank other than 0: takes work, feeds it to its runner, sends back what happened. It ends when
/// the manager says Quit.
class Worker {
 public:
  Worker(Link& link, JobRunner& runner) : link_(link), runner_(runner) {}
  /// One turn: messages, runner, report. Waits at most timeout_ms when there is work under way.
  /// False after Quit.
  bool turn(int timeout_ms);
  /// Something was done in the last turn, or a job is under way (whose pipe is waited for).
  bool is_busy() const { return busy_; }

 private:
  void take(const message::Work& work);
  void release();
  void tell(const Message& message) { link_.send(0, message); }
  void collect(JobEvents events);
  void report(bool now);

  Link& link_;
  JobRunner& runner_;
  int family_ = -1;
  bool draining_ = false, said_drained_ = false, quit_ = false, busy_ = false;
  bool in_trouble_ = false;
  std::map<std::int64_t, std::string> sources_;  ///< of base scenes, which the runner holds.
  JobEvents pending_;
  faultsim::Stopwatch since_report_;
};

/// The main loop of a worker rank, until Quit or until must_leave().
void run_worker(Link& link, JobRunner& runner, const std::string& host,
                const std::function<bool()>& must_leave);

}  // namespace faultsweep
