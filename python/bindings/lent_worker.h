#pragma once

#include <exception>
#include <functional>

#include "simulator/common/run_context.h"

namespace faultsim::python {

class Worker;

/// A thread that does one piece of work for whoever holds this. Threads are kept when it is done,
/// and wait for the next work: a new one for each costs more than a case in plane strain. There are
/// as many as were at work at once; a forked process, which has none of them, starts its own.
/// All but ends_soon() is @pre with Python's lock held: that guards the lists of threads.
class LentWorker {
 public:
  /// Begins. Throws std::system_error where a new thread is needed and there can be none.
  /// @pre the work outlives this.
  explicit LentWorker(const std::function<void(StopToken)>& work);
  /// @pre the work has ended.
  ~LentWorker();
  LentWorker(const LentWorker&) = delete;
  LentWorker& operator=(const LentWorker&) = delete;

  /// Whether the work has ended, after 10 ms if it has not.
  bool ends_soon();
  void stop();
  bool is_stopped() const;
  std::exception_ptr failure() const;  ///< what the work threw. @pre it has ended.

  static void stop_all();      ///< asks all works to stop.
  static bool are_all_idle();  ///< nobody holds a worker.

 private:
  Worker& worker_;
};

}  // namespace faultsim::python
