#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <mutex>

#include "simulator/common/run_context.h"

namespace faultsim::python {

/// Runs work in a thread of its own (LentWorker), without Python's lock, while the calling thread
/// looks for signals every 10 ms: what a handler raises (KeyboardInterrupt) asks the work to stop,
/// and is raised here once it has ended. What the work throws is thrown here.
/// @param look  called with Python's lock after every look for signals, and once at the end of work
///              that did not fail; what it raises stops the work likewise.
/// @pre the calling thread holds Python's lock.
void run_watched(const std::function<void(StopToken)>& work,
                 const std::function<void()>& look = nullptr);

/// For the end of Python, before its threads can no longer come back to it: works that other
/// threads have begun are stopped and waited for, and from now on they begin none (Interrupted).
/// @pre the calling thread holds Python's lock.
void end_watched_works();

/// Holds what one caller may use at a time, as long as it lives. A callback of its own finds it
/// held too, which a mutex would not allow to be asked.
class HeldAlone {
 public:
  /// Throws RuntimeError (Python) where it is held. @param what  "simulation".
  HeldAlone(std::atomic<bool>& is_held, const char* what);
  ~HeldAlone() { is_held_ = false; }
  HeldAlone(const HeldAlone&) = delete;
  HeldAlone& operator=(const HeldAlone&) = delete;

 private:
  std::atomic<bool>& is_held_;
};

/// Takes what the work says, from its thread, and hands the newest of it to a function of Python's
/// from the thread that called: monitor(fraction, what).
class ToldMonitor final : public Monitor {
 public:
  /// @param told  callable or None.
  explicit ToldMonitor(pybind11::object told) : told_(std::move(told)) {}
  void progress(double fraction, const std::string& what) override;
  void note(const std::string&) override {}
  void hand_over();  ///< @pre as run_watched: look.

 private:
  pybind11::object told_;
  std::mutex mutex_;
  bool is_new_ = false;
  double fraction_ = 0;
  std::string what_;
};

}  // namespace faultsim::python
