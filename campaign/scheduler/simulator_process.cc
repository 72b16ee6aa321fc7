#include "campaign/scheduler/simulator_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string_view>
#include <utility>

#include "campaign/common/names.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {
namespace {

constexpr int kChildRequests = 3;
constexpr int kChildReplies = 4;
constexpr int kFirstOwnDescriptor = 10;  // clear of the numbers that the child will use

void close_descriptor(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

struct Pipe {
  int read = -1, write = -1;
  Pipe() = default;
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_descriptor(read);
    close_descriptor(write);
  }
  void open() {
    std::array<int, 2> ends = {-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw ResourceError(concat("cannot open a pipe to the simulator: ", std::strerror(errno)));
    }
    read = fcntl(ends[0], F_DUPFD_CLOEXEC, kFirstOwnDescriptor);
    write = fcntl(ends[1], F_DUPFD_CLOEXEC, kFirstOwnDescriptor);
    close(ends[0]);
    close(ends[1]);
    if (read < 0 || write < 0) throw ResourceError("too many open files to start the simulator");
  }
};

std::vector<std::string> clean_environment() {
  std::vector<std::string> kept;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const bool is_rank = text.starts_with("OMPI_") || text.starts_with("PMIX_") ||
                         text.starts_with("PMI_") || text.starts_with("SLURM_");
    if (!is_rank) kept.emplace_back(text);
  }
  return kept;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

/// posix_spawn's two argument objects, with everything that the child needs.
struct SpawnSetup {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;

  SpawnSetup(int requests, int replies, int log) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, log, 1);
    posix_spawn_file_actions_adddup2(&actions, log, 2);
    posix_spawn_file_actions_adddup2(&actions, requests, kChildRequests);
    posix_spawn_file_actions_adddup2(&actions, replies, kChildReplies);
    // MPI leaves descriptors open that are not close-on-exec.
    posix_spawn_file_actions_addclosefrom_np(&actions, kChildReplies + 1);
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(
        &attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
};

/// Appends what is there, and closes the descriptor at its end.
void read_available(int& descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  constexpr int kMostReads = 64;  // a chatty child must not keep us from its replies
  for (int k = 0; k < kMostReads && descriptor >= 0; ++k) {
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count > 0) {
      text.append(buffer.data(), static_cast<std::size_t>(count));
    } else if (count < 0 && errno == EAGAIN) {
      return;
    } else if (count == 0 || errno != EINTR) {
      close_descriptor(descriptor);
    }
  }
}

void set_non_blocking(int descriptor) {
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) | O_NONBLOCK);
}

}  // namespace

std::string describe(const ProcessEnd& end) {
  if (end.signal) {
    const char* name = sigabbrev_np(*end.signal);
    return concat("killed by SIG", name != nullptr ? name : "?", " (", *end.signal, ")");
  }
  return concat("ended with exit code ", end.exit_code.value_or(-1));
}

SimulatorProcess::SimulatorProcess(const Options& options) {
  Pipe requests, replies, log;
  requests.open();
  replies.open();
  log.open();
  std::vector<std::string> arguments = {options.binary.string(),
                                        options.command,
                                        "--requests",
                                        std::to_string(kChildRequests),
                                        "--replies",
                                        std::to_string(kChildReplies),
                                        "--threads",
                                        std::to_string(options.threads)};
  const auto add = [&](const char* option, const std::string& value) {
    arguments.insert(arguments.end(), {option, value});
  };
  if (!options.cache.empty()) add("--cache", options.cache.string());
  if (!options.node_cache.empty()) add("--node-cache", options.node_cache.string());
  if (options.memory_limit) {  // set by the child itself, once its linear algebra has what it takes
    add("--memory-limit", std::to_string(std::llround(*options.memory_limit)));
  }
  std::vector<std::string> environment = clean_environment();
  const SpawnSetup setup(requests.read, replies.write, log.write);
  const int error = posix_spawn(&pid_, options.binary.c_str(), &setup.actions, &setup.attributes,
                                pointers(arguments).data(), pointers(environment).data());
  if (error != 0) {
    throw ResourceError(
        concat("cannot start the simulator ", options.binary.string(), ": ", std::strerror(error)));
  }
  // Fails only if the child is gone already, which the pipes will tell.
  std::ofstream(concat("/proc/", pid_, "/oom_score_adj")) << 1000;
  requests_ = std::exchange(requests.write, -1);
  replies_ = std::exchange(replies.read, -1);
  log_ = std::exchange(log.read, -1);
  for (const int descriptor : {requests_, replies_, log_}) set_non_blocking(descriptor);
}

SimulatorProcess::~SimulatorProcess() {
  if (pid_ > 0) {
    kill();
    wait(0);
  }
  close_descriptor(requests_);
  close_descriptor(replies_);
  close_descriptor(log_);
}

void SimulatorProcess::send(const std::string& line) { outbox_.push_back(line + '\n'); }

void SimulatorProcess::finish() { finish_ = true; }

void SimulatorProcess::exchange(int timeout_ms) {
  write_requests();
  std::array<pollfd, 3> waits = {pollfd{replies_, POLLIN, 0}, pollfd{log_, POLLIN, 0},
                                 pollfd{outbox_.empty() ? -1 : requests_, POLLOUT, 0}};
  if (poll(waits.data(), waits.size(), timeout_ms) <= 0) return;
  if (waits[0].revents != 0) read_replies();
  if (waits[1].revents != 0) read_log();
  if (waits[2].revents != 0) write_requests();
}

void SimulatorProcess::write_requests() {
  while (requests_ >= 0 && !outbox_.empty()) {
    const std::string& line = outbox_.front();
    // SIGPIPE is ignored by the program: a dead child is EPIPE here, and silence on the other pipe.
    const ssize_t count = write(requests_, line.data() + written_, line.size() - written_);
    if (count < 0) {
      if (errno == EINTR) continue;
      if (errno != EAGAIN) close_descriptor(requests_);
      return;
    }
    written_ += static_cast<std::size_t>(count);
    if (written_ == line.size()) {
      outbox_.pop_front();
      written_ = 0;
    }
  }
  if (finish_ && outbox_.empty()) close_descriptor(requests_);
}

void SimulatorProcess::read_replies() {
  read_available(replies_, inbox_);
  if (inbox_.size() > kLongestReply && inbox_.find('\n') == std::string::npos) {
    overflowed_ = true;
    close_descriptor(replies_);
  }
}

void SimulatorProcess::read_log() {
  read_available(log_, log_text_);
  if (log_text_.size() > kLogTail) log_text_.erase(0, log_text_.size() - kLogTail);
}

std::optional<std::string> SimulatorProcess::next_reply() {
  const std::size_t end = inbox_.find('\n', scanned_);
  if (end == std::string::npos) {
    scanned_ = inbox_.size();
    // Half a line at the end of the pipe is for the caller to judge, too.
    if (!is_silent() || inbox_.empty()) return std::nullopt;
    scanned_ = 0;
    return std::exchange(inbox_, std::string());
  }
  std::string line = inbox_.substr(0, end);
  inbox_.erase(0, end + 1);
  scanned_ = 0;
  return line;
}

std::optional<std::string> SimulatorProcess::next_bytes(std::size_t n) {
  if (inbox_.size() < n) return std::nullopt;
  std::string bytes = inbox_.substr(0, n);
  inbox_.erase(0, n);
  scanned_ = 0;
  return bytes;
}

ProcessEnd SimulatorProcess::wait(double grace_seconds) {
  FAULTSIM_DEMAND(pid_ > 0, pid_);
  const faultsim::Stopwatch watch;
  int status = 0;
  while (waitpid(pid_, &status, WNOHANG) == 0) {
    read_log();
    if (watch.seconds() > grace_seconds) kill();
    const timespec pause = {0, 1000000};
    nanosleep(&pause, nullptr);
  }
  read_log();
  pid_ = -1;
  ProcessEnd end;
  if (WIFSIGNALED(status)) {
    end.signal = WTERMSIG(status);
  } else {
    end.exit_code = WEXITSTATUS(status);
  }
  return end;
}

void SimulatorProcess::kill() {
  if (pid_ > 0) ::kill(-pid_, SIGKILL);
}

std::string SimulatorProcess::log_tail() const {
  std::string tail = log_text_;
  // The store keeps text: anything else becomes '?'.
  for (char& c : tail) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte >= 0x7f) c = '?';
  }
  return tail;
}

}  // namespace faultsweep
