#pragma once

#include <deque>
#include <limits>
#include <list>
#include <memory>
#include <optional>

#include "campaign/scheduler/wire.h"

namespace faultsweep {

/// MPI for the campaign: whole messages, sent without waiting, received by looking. Neither side
/// ever blocks inside MPI, as MPI waits by spinning: whoever has nothing to do sleeps (see
/// IdleSleep).
class Messenger final : public Link {
 public:
  /// Starts MPI. One per process.
  Messenger(int& argc, char**& argv);
  /// Ends MPI together with all ranks; prefer finish().
  ~Messenger() override;
  Messenger(const Messenger&) = delete;
  Messenger& operator=(const Messenger&) = delete;

  int rank() const { return rank_; }
  int size() const override { return size_; }
  void send(int to, const Message& message) override;
  std::optional<Received> receive() override;
  /// Everything that was sent has left.
  bool is_flushed();
  /// Ends MPI in order: every rank must call it. Waits, asleep, for what was sent; what arrives is
  /// thrown away. False if the others were not there after `patience` seconds.
  bool finish(double patience = std::numeric_limits<double>::infinity());
  /// Ends all ranks now.
  [[noreturn]] void abort(int code);

 private:
  struct Transfer;
  void accept();

  int rank_ = 0, size_ = 0;
  bool finished_ = false;
  std::list<std::unique_ptr<Transfer>> outbox_;
  std::deque<std::unique_ptr<Transfer>> inbox_;  ///< in order of arrival
};

/// Sleeps that grow from 50 µs while nothing happens: short enough not to be felt, long enough that
/// looking costs less than 2 % of a core.
class IdleSleep {
 public:
  /// @param longest  µs, the most that a message waits. A manager may sleep longer than a worker,
  ///                 as workers have work ahead (WorkPlan::kSliceSeconds).
  explicit IdleSleep(int longest = 2000) : longest_(longest) {}
  void reset() { microseconds_ = kShortest; }
  void sleep();
  /// Of a main loop: sleeps unless something was done.
  void after_turn(bool busy) { busy ? reset() : sleep(); }
  static constexpr int kShortest = 50;
  static constexpr int kManagerLongest = 10000;

 private:
  int longest_;
  int microseconds_ = kShortest;
};

}  // namespace faultsweep
