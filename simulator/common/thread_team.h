#pragma once

#include <functional>
#include <memory>

namespace faultsim {

/// Threads that a case is worth at most: what it waits for is memory, which all cores share.
constexpr int kMostThreadsOfCase = 4;

/// Threads that stay and share the work of one simulation, piece after piece: its own, and others
/// that sleep in between. The others are started by the first work there is; none of it is needed
/// for it to be done, so a machine that is busy elsewhere does not hold it up. For one thread at a
/// time.
class ThreadTeam {
 public:
  /// @param n_threads  with that of the caller, at least 1.
  explicit ThreadTeam(int n_threads);
  ~ThreadTeam();  ///< ends the others.

  /// Fewer than asked for since a limit on processes left no room for one.
  int n_threads() const { return n_threads_; }
  /// Calls task(0) … task(n − 1), each once, by the caller and by whichever others come in time.
  /// They are begun in this order, so a task may wait for what those before it have yet to do. The
  /// first exception is thrown when all that was begun has ended; no further task is begun, so one
  /// that others wait for must not throw.
  /// @pre not called by a task.
  void for_each(int n, const std::function<void(int)>& task);
  long n_works() const;  ///< calls of for_each so far.
  /// Tasks so far that were not done by the caller.
  long n_taken_by_others() const;

 private:
  struct Shared;
  int n_threads_;
  std::unique_ptr<Shared> shared_;
};

/// The same by a team that may be missing (null) or not be worth it (n < 2): one after the other.
void for_each(ThreadTeam* team, int n, const std::function<void(int)>& task);

/// Waits a moment: the processor rests, and after some rounds others may have the core.
/// @param round  0, 1, 2, … of the wait.
void wait_a_moment(int round);

}  // namespace faultsim
