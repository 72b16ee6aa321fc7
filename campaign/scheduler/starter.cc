#include "campaign/scheduler/starter.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <set>
#include <vector>

#include "campaign/common/names.h"
#include "campaign/scheduler/resources.h"
#include "campaign/store/store.h"
#include "simulator/common/stopwatch.h"
#include "simulator/files/temporary_folder.h"

namespace faultsweep {
namespace {

constexpr int kTearDownSeconds = 2;  // a commit takes milliseconds, and is whole or not at all

volatile std::sig_atomic_t n_signals = 0;

extern "C" void count_signal(int) { n_signals = n_signals + 1; }

/// Counts the signals that ask to stop, for as long as it lives.
class StopSignals {
 public:
  StopSignals() {
    n_signals = 0;
    struct sigaction action = {};
    action.sa_handler = count_signal;
    sigemptyset(&action.sa_mask);
    for (int k = 0; k < kCount; ++k) {
      sigaction(kSignals[k], nullptr, &before_[k]);
      if (kSignals[k] == SIGHUP && before_[k].sa_handler == SIG_IGN) continue;  // nohup
      sigaction(kSignals[k], &action, nullptr);
    }
  }
  ~StopSignals() {
    for (int k = 0; k < kCount; ++k) sigaction(kSignals[k], &before_[k], nullptr);
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  static constexpr int kCount = 4;
  static constexpr int kSignals[kCount] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};
  struct sigaction before_[kCount];
};

/// Where the manager leaves the campaign's status, removed at the end. It lies in the store, as the
/// manager may be on another host.
class StatusFile {
 public:
  explicit StatusFile(const std::filesystem::path& store) {
    std::string name = (std::filesystem::absolute(store) / ".status-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    if (descriptor < 0) {
      throw StorageError(concat("cannot make ", name, ": ", std::strerror(errno)));
    }
    close(descriptor);
    path_ = name;
    clear();
  }
  ~StatusFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  StatusFile(const StatusFile&) = delete;
  StatusFile& operator=(const StatusFile&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// What the manager left.
  struct Left {
    std::optional<ExitCode> code;  ///< none = it could not leave anything.
    std::string reason;            ///< of a failure, in its words.
  };
  Left read() const {
    std::ifstream file(path_);
    Left left;
    if (int code = 0; file >> code) left.code = static_cast<ExitCode>(code);
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line) && line.find_first_not_of(' ') < line.size())
      left.reason += (left.reason.empty() ? "" : "\n") + line;
    return left;
  }
  /// Blanks, over which the manager can write when the disk is full.
  void clear() const {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file << std::string(kLongestReason + 16, ' ');
  }

 private:
  std::filesystem::path path_;
};

/// A manager and its workers; none = as many as the hostfile has slots.
std::optional<int> wanted_ranks(const RunOptions& options) {
  if (options.n_workers) return *options.n_workers + 1;
  if (!options.hostfile.empty()) return std::nullopt;
  return default_workers() + 1;
}

bool is_one_host(const RunOptions& options) {
  return options.hostfile.empty() &&
         slurm_number(std::getenv("SLURM_JOB_NUM_NODES")).value_or(1) == 1;
}

std::vector<std::string> mpirun_command(const RunOptions& options,
                                        const std::filesystem::path& scratch,
                                        const StatusFile& status) {
  const char* mpirun = std::getenv("FAULTSWEEP_MPIRUN");
  std::vector<std::string> command = {mpirun != nullptr ? mpirun : "mpirun",
                                      // more ranks than cores, as the manager sleeps
                                      "--oversubscribe",
                                      // a bound rank would bind its simulator's threads to one core
                                      "--bind-to", "none",
                                      // containers forbid process_vm_readv, which vader would use
                                      "--mca", "btl_vader_single_copy_mechanism", "none",
                                      // ranks have this long to commit after SIGTERM
                                      "--mca", "odls_base_sigkill_timeout",
                                      std::to_string(kTearDownSeconds)};
  const auto add = [&command](std::initializer_list<std::string> words) {
    command.insert(command.end(), words);
  };
  if (const auto n_ranks = wanted_ranks(options)) add({"-n", std::to_string(*n_ranks)});
  if (!options.hostfile.empty()) {
    add({"--hostfile", std::filesystem::absolute(options.hostfile).string()});
  }
  // Only where all ranks are here: on other hosts nobody would remove the folder.
  if (is_one_host(options)) add({"--mca", "orte_tmpdir_base", scratch.string()});
  if (geteuid() == 0) add({"--allow-run-as-root"});
  add({std::filesystem::read_symlink("/proc/self/exe").string(), "run", options.campaign, "--store",
       std::filesystem::absolute(options.store).string(), "--simulator", options.simulator.string(),
       "--progress", to_string(options.progress), "--status-file", status.path().string()});
  if (options.memory_bytes) add({"--memory", options.memory});
  if (options.threads) add({"--threads", std::to_string(*options.threads)});
  if (!options.node_cache.empty()) add({"--node-cache", options.node_cache});
  return command;
}

/// Starts the command in a process group of its own, so that Ctrl-C reaches only us; it is told to
/// end when we die.
pid_t spawn(std::vector<std::string> command) {
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0)
    throw ResourceError(concat("cannot start ", command[0], ": ", std::strerror(errno)));
  if (child == 0) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGPIPE})
      std::signal(number, SIG_DFL);
    const int null = open("/dev/null", O_RDONLY);
    dup2(null, 0);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  return child;
}

void pause_shortly() {
  const timespec pause = {0, 20'000'000};
  nanosleep(&pause, nullptr);
}

/// The process is ours by its program, and no zombie.
bool is_rank_alive(pid_t pid, const std::filesystem::path& program) {
  std::error_code error;  // a zombie has no program
  return std::filesystem::read_symlink(concat("/proc/", pid, "/exe"), error) == program && !error;
}

/// mpirun's ranks on this host.
std::vector<pid_t> living_ranks(pid_t mpirun) {
  std::vector<pid_t> living;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const std::string tasks = concat("/proc/", mpirun, "/task");
  for (const auto& task : std::filesystem::directory_iterator(tasks, error)) {
    std::ifstream children(task.path() / "children");
    for (pid_t child = 0; children >> child;) {
      if (is_rank_alive(child, program)) living.push_back(child);
    }
  }
  return living;
}

/// Ends a job whose rank has died. Open MPI 4.1 would do so itself, but only after it has slept
/// odls_base_sigkill_timeout before SIGTERM and again before SIGKILL. We tell the other ranks to
/// leave, and end mpirun when nobody is left. Where some ranks are on other hosts that is left to
/// Open MPI, which alone knows when these have ended.
class JobWatch {
 public:
  /// @param n_ranks  none = not known: Open MPI's.
  explicit JobWatch(std::optional<int> n_ranks) : n_ranks_(n_ranks) {}
  void look_after(pid_t mpirun) {
    if (since_look_.seconds() < kLookSeconds) return;
    since_look_ = {};
    const std::vector<pid_t> living = living_ranks(mpirun);
    seen_.insert(living.begin(), living.end());
    if (!n_ranks_) return;
    if (living.size() == static_cast<std::size_t>(*n_ranks_)) {
      all_were_here_ = true;
      since_loss_ = {};
    }
    if (!all_were_here_ || since_loss_.seconds() < kGraceSeconds) return;
    for (const pid_t rank : living) kill(rank, SIGTERM);
    if (living.empty()) kill(mpirun, SIGKILL);
    since_loss_ = {};
  }
  /// Ends the ranks on this host that have outlived their mpirun, as when that was killed: they
  /// commit what they have when asked to, and have kTearDownSeconds for it.
  void end_orphans() const {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    const faultsim::Stopwatch watch;
    bool any = true;
    for (int number = SIGTERM; any; number = watch.seconds() > kTearDownSeconds ? SIGKILL : 0) {
      any = false;
      for (const pid_t rank : seen_) {
        if (!is_rank_alive(rank, program)) continue;
        any = true;
        kill(rank, number);  // 0 only asks
      }
      if (any) pause_shortly();
    }
  }

 private:
  static constexpr double kLookSeconds = 0.2;
  static constexpr double kGraceSeconds = 1;  // an ordinary end takes a tenth of that
  std::optional<int> n_ranks_;
  bool all_were_here_ = false;
  std::set<pid_t> seen_;
  faultsim::Stopwatch since_look_, since_loss_;
};

/// A manager on another host may live on for a while after its mpirun was killed. Returns when the
/// store is free, or after a minute: then the next manager says whose it is.
void wait_for_store(const RunOptions& options) {
  constexpr double kLongest = 75;  // a silent manager on another host counts as dead after 60 s
  const faultsim::Stopwatch watch;
  while (n_signals == 0 && watch.seconds() < kLongest) {
    const auto owner = Store::open_reader(options.store).owner();
    if (!owner || !owner->alive) return;
    pause_shortly();
  }
}

/// Waits for mpirun, passing on requests to stop. Returns waitpid's status.
int wait_for(pid_t mpirun, JobWatch& watch) {
  int told = 0;
  faultsim::Stopwatch since_told;
  constexpr double kRepeatSeconds = 1;   // a signal that came before the ranks listened is lost
  constexpr double kTearDownLimit = 10;  // mpirun may hang, and nobody need ask a third time
  for (;;) {
    int status = 0;
    if (waitpid(mpirun, &status, WNOHANG) == mpirun) return status;
    if (told == 2 && since_told.seconds() > kTearDownLimit) kill(-mpirun, SIGKILL);
    const int wanted = std::min(int{n_signals}, 3);
    if (wanted > told || (wanted == 1 && since_told.seconds() > kRepeatSeconds)) {
      told = wanted;
      since_told = {};
      if (wanted == 1) kill(mpirun, SIGUSR1);  // mpirun passes SIGUSR1 to the ranks
      if (wanted == 2) kill(mpirun, SIGTERM);
      if (wanted == 3) kill(-mpirun, SIGKILL);
    }
    watch.look_after(mpirun);
    pause_shortly();
  }
}

/// mpirun ends with 128 + n when a rank died by signal n, or dies itself.
bool died_by_signal(int status) {
  if (WIFSIGNALED(status)) return true;
  constexpr int kSignalBase = 128;
  return WEXITSTATUS(status) > kSignalBase && WEXITSTATUS(status) <= kSignalBase + SIGRTMIN;
}

long finished_cases(const RunOptions& options) {
  const CampaignInfo info = Store::open_reader(options.store).campaign(options.campaign);
  // Fields that are added to decided cases are progress as well.
  return info.n_done + info.n_failed + info.n_fields_kept + info.n_fields_failed;
}

/// Notes a restart in the store; trouble with the store shows in the next manager anyway.
void note_restart(const RunOptions& options, const std::string& text) {
  std::fprintf(stderr, "faultsweep: %s\n", text.c_str());
  try {
    Store store = Store::open_writer(options.store);
    store.record_event(store.campaign(options.campaign).id, "restart", text);
  } catch (const faultsim::Error& error) {
    std::fprintf(stderr, "faultsweep: %s\n", error.what());
  }
}

void check_before(RunOptions& options) {
  std::error_code error;
  if (std::filesystem::file_size(options.store / "campaign.sqlite", error) == 0 || error)
    Store::open_reader(options.store);  // says what is missing
  Store store = Store::open_writer(options.store);
  const CampaignInfo info = store.campaign(options.campaign);
  options.campaign = info.name;  // "the newest" stays the same one through restarts
  store.dead_owner();            // or a living one, which is said
  if (access(options.simulator.c_str(), X_OK) != 0) {
    throw ResourceError(concat("there is no simulator at ", options.simulator.string(),
                               "; set FAULTSIM_BINARY to the faultsim binary"));
  }
  if (info.cancelled) {
    throw InputError("--campaign", concat(info.name, " was cancelled"),
                     "submit its spec again to reopen it");
  }
}

ExitCode status_without_manager(int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
    throw ResourceError("cannot run mpirun; install openmpi-bin, or set FAULTSWEEP_MPIRUN");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(ExitCode::bug))
    return ExitCode::bug;
  return ExitCode::world;
}

}  // namespace

ExitCode start_ranks(const RunOptions& given) {
  RunOptions options = given;
  const StopSignals stop_signals;  // first of all: a batch system's signal must not kill us
  check_before(options);
  const faultsim::TemporaryFolder scratch;  // of mpirun: a killed one leaves its files behind
  const StatusFile status(options.store);
  int n_restarts = 0;
  long finished = finished_cases(options);
  for (;;) {
    status.clear();
    JobWatch watch(wanted_ranks(options));
    const int ended = wait_for(spawn(mpirun_command(options, scratch.path(), status)), watch);
    watch.end_orphans();
    const auto [left, reason] = status.read();
    if (!reason.empty()) std::fprintf(stderr, "faultsweep: %s\n", reason.c_str());
    if (n_signals > 0) {
      // In order, the campaign may even have been completed; else it can be resumed.
      return left && n_signals == 1 ? *left : ExitCode::interrupted;
    }
    if (left && *left != ExitCode::interrupted) return *left;
    // A manager that was torn down, or that left nothing.
    if (!left && !died_by_signal(ended)) return status_without_manager(ended);
    const long now = finished_cases(options);
    if (now > finished) n_restarts = 0;
    finished = now;
    if (++n_restarts > kMostRestarts) {
      throw ResourceError(
          concat("the job died ", kMostRestarts + 1,
                 " times in a row without finishing a case; what is stored is intact"));
    }
    wait_for_store(options);
    note_restart(options, concat("a process of the job died (mpirun status ", ended, "); restart ",
                                 n_restarts, " of ", kMostRestarts));
  }
}

SubmittedRun submit_and_run(const Submission& submission, RunOptions options) {
  options.campaign = Store::open_writer(options.store).submit(submission).name;
  return {options.campaign, start_ranks(options)};
}

}  // namespace faultsweep
