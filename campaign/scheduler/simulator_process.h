#pragma once

#include <sys/types.h>

#include <deque>
#include <filesystem>
#include <optional>
#include <string>

namespace faultsweep {

/// How a child ended.
struct ProcessEnd {
  std::optional<int> signal;
  std::optional<int> exit_code;
};

/// "killed by SIGSEGV (11)", "ended with exit code 3".
std::string describe(const ProcessEnd& end);

/// A `faultsim worker` child (schemas/worker_protocol.md), or a `faultsim what-if` one
/// (what_if_protocol.md), and the pipes to it.
///
/// The child gets: its own process group, so that a Ctrl-C at the terminal is ours to handle;
/// signal mask and handlers reset; descriptors 0 (null), 1 and 2 (the log), 3 (requests), 4
/// (replies) and no other; an environment without OMPI_*, PMIX_*, PMI_* and SLURM_*, for it is not
/// a rank; an OOM score of 1000, so that the kernel takes it and not a rank. It sees the end of the
/// request pipe when we die.
class SimulatorProcess {
 public:
  struct Options {
    std::filesystem::path binary;
    const char* command = "worker";
    std::filesystem::path cache;         ///< operator cache; empty = none.
    std::filesystem::path node_cache;    ///< copies on the host's own disk; empty = none.
    std::optional<double> memory_limit;  ///< bytes of private memory (RLIMIT_DATA).
    int threads = 1;                     ///< of building an operator.
  };
  /// Starts it. Throws ResourceError when that is not possible.
  explicit SimulatorProcess(const Options& options);
  /// Kills it if it still runs.
  ~SimulatorProcess();
  SimulatorProcess(const SimulatorProcess&) = delete;
  SimulatorProcess& operator=(const SimulatorProcess&) = delete;

  /// Queues one request line; written as the pipe takes it.
  void send(const std::string& line);
  /// No more requests: the child ends when it has read them all.
  void finish();
  /// Moves bytes; waits for at most timeout_ms while there is nothing to move.
  void exchange(int timeout_ms);
  /// The next whole reply line; nothing = none is there.
  std::optional<std::string> next_reply();
  /// The next n bytes, which are not a line; nothing = they are not all there.
  std::optional<std::string> next_bytes(std::size_t n);
  /// The reply pipe is at its end: no more replies, the process is ending or gone.
  bool is_silent() const { return replies_ < 0; }
  /// Takes the process's end, killing it if it has not ended after grace_seconds.
  ProcessEnd wait(double grace_seconds);
  void kill();

  /// The last bytes that it and its libraries printed.
  std::string log_tail() const;
  pid_t pid() const { return pid_; }

  static constexpr std::size_t kLogTail = 4096;  ///< bytes kept for the store.
  static constexpr std::size_t kLongestReply =
      64 << 20;  ///< bytes; more without a newline is garbage.
  /// A reply line longer than kLongestReply was cut off.
  bool overflowed() const { return overflowed_; }

 private:
  void write_requests();
  void read_replies();
  void read_log();

  pid_t pid_ = -1;
  int requests_ = -1, replies_ = -1, log_ = -1;
  bool finish_ = false;
  bool overflowed_ = false;
  std::deque<std::string> outbox_;
  std::size_t written_ = 0;  ///< bytes of outbox_.front().
  std::string inbox_;
  std::size_t scanned_ = 0;  ///< bytes of inbox_ known to hold no newline.
  std::string log_text_;
};

}  // namespace faultsweep
