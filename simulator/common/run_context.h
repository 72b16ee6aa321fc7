#pragma once

#include <atomic>
#include <string>
#include <utility>

namespace faultsim {

/// Where progress and remarks go. Kernels never print; they tell a Monitor.
class Monitor {
 public:
  virtual ~Monitor() = default;
  /// A stage of long work: fraction in [0, 1], "factorising 257,049 unknowns".
  virtual void progress(double fraction, const std::string& what) = 0;
  /// A remark worth reading (a warning with its figures).
  virtual void note(const std::string& text) = 0;
};

/// Says nothing.
class SilentMonitor final : public Monitor {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string&) override {}
};

/// Tells another what a part of the work is doing: "operator 3 of a surface: meshing".
class PartMonitor final : public Monitor {
 public:
  /// @param whole  told; null: nobody listens. @pre it outlives this.
  PartMonitor(Monitor* whole, std::string part) : whole_(whole), part_(std::move(part)) {}
  /// The fraction is the part's own.
  void progress(double fraction, const std::string& what) override {
    if (whole_ != nullptr) whole_->progress(fraction, part_ + ": " + what);
  }
  void note(const std::string& text) override {
    if (whole_ != nullptr) whole_->note(text);
  }

 private:
  Monitor* whole_;
  std::string part_;
};

/// Whether work that was given it should end soon: a view of a flag that somebody else owns and may
/// set from any thread, or from a signal handler. Long work asks at least every few milliseconds.
class StopToken {
 public:
  StopToken() = default;  ///< never asks to stop.
  /// @pre the flag outlives the work.
  explicit StopToken(const std::atomic<bool>& flag) : flag_(&flag) {}
  bool requested() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }
  /// Throws Interrupted("stopped while DOING") if requested().
  void throw_if_requested(const char* doing) const;

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

class FactorAnalysis;  // linalg/cholesky.h
class ThreadTeam;      // thread_team.h

/// What a piece of work is given beside its data; nothing of it changes a bit of the result. All
/// that differs between two simulations in one process is here or in their data.
struct RunContext {
  RunContext() = default;  ///< silent, never stopped, one thread.
  // Not explicit: to most work the monitor is all of the context.
  RunContext(Monitor& told, StopToken stop_token = {}, int threads = 1)  // NOLINT
      : monitor(&told), stop(stop_token), n_threads(threads) {}

  void progress(double fraction, const std::string& what) const {
    if (monitor != nullptr) monitor->progress(fraction, what);
  }
  void note(const std::string& text) const {
    if (monitor != nullptr) monitor->note(text);
  }

  Monitor* monitor = nullptr;  ///< null: nobody listens. Called by the thread that was called.
  StopToken stop;
  int n_threads = 1;                   ///< of a factorisation, at most.
  ThreadTeam* team = nullptr;          ///< that shares the work of a case; null: one thread.
  FactorAnalysis* analysis = nullptr;  ///< kept by whoever factorises several alike matrices.
};

}  // namespace faultsim
