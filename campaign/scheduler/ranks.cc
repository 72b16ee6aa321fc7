#include "campaign/scheduler/ranks.h"

#include <linux/magic.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>

#include "campaign/common/names.h"
#include "campaign/scheduler/local_runner.h"
#include "campaign/scheduler/manager.h"
#include "campaign/scheduler/messenger.h"
#include "campaign/scheduler/resources.h"
#include "campaign/scheduler/worker.h"
#include "simulator/common/stopwatch.h"

namespace faultsweep {
namespace {

volatile std::sig_atomic_t stop_wanted = 0;
volatile std::sig_atomic_t torn_down = 0;

extern "C" void on_stop(int) { stop_wanted = 1; }
extern "C" void on_tear_down(int) { torn_down = 1; }

void on_signal(int number, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

void set_signals(bool is_manager) {
  on_signal(SIGUSR1, is_manager ? on_stop : SIG_IGN);
  on_signal(SIGTERM, on_tear_down);
  on_signal(SIGINT, SIG_IGN);   // the terminal's Ctrl-C is for the starter
  on_signal(SIGPIPE, SIG_IGN);  // a dead simulator shows as EPIPE
  on_signal(SIGXFSZ, SIG_IGN);  // a file size limit shows as a full disk
}

/// This process's CPU time so far, s.
double cpu_seconds() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

constexpr double kLastPatience = 10;  // s for a lock when all results are stored

std::string hundredths(double value) { return formatted("%.2f", value); }

/// Overwrites what the starter has put there to keep the place: the disk may be full. False if
/// there is no starter, or it could not be told.
bool leave_status(const RunOptions& options, ExitCode status, const std::string& reason) {
  if (options.status_file.empty()) return false;
  std::fstream file(options.status_file, std::ios::in | std::ios::out | std::ios::binary);
  file << static_cast<int>(status) << '\n' << reason.substr(0, kLongestReason) << '\n';
  return static_cast<bool>(file.flush());
}

/// Runs the campaign; how it ended. Messages go to stderr.
ExitCode manage(Messenger& messenger, const RunOptions& options, bool& in_order) {
  const faultsim::Stopwatch since_start;
  const double cpu_before = cpu_seconds();  // of starting MPI
  ProgressDisplay display(options.progress);
  Store store = Store::open_owner(options.store);
  if (!store.remark().empty()) display.note(store.remark());
  MemoryForOperators memory{options.memory_bytes.value_or(0), ""};
  if (!options.memory_bytes) memory = memory_for_operators(available_memory(), physical_memory());
  if (!memory.remark.empty()) display.note(memory.remark);
  Manager manager(store, messenger, display,
                  {.campaign = options.campaign,
                   .memory_bytes = memory.bytes,
                   .is_stopped = [] { return stop_wanted != 0 || torn_down != 0; },
                   .threads = options.threads,
                   .next_round = options.next_round,
                   .shown_first = options.shown_first});
  IdleSleep idle(IdleSleep::kManagerLongest);
  while (manager.turn()) {
    if (stop_wanted != 0) manager.interrupt();
    if (torn_down != 0) {
      constexpr int kTries = 10;  // within the starter's kTearDownSeconds
      for (int k = 0; k < kTries && !manager.commit(); ++k) {
      }
      in_order = false;
      return ExitCode::interrupted;
    }
    idle.after_turn(manager.is_busy());
  }
  in_order = manager.workers_are_drained();
  store.wait_for_locks(kLastPatience);
  if (!manager.trouble().empty())
    std::fprintf(stderr, "faultsweep: %s\n", manager.trouble().c_str());
  try {
    const CampaignInfo info = store.campaign(options.campaign);
    display.finish({info.n_cases, info.n_done, info.n_failed, -1, ""});
    store.record_event(
        info.id, "stopped",
        concat(info.n_done, " done, ", info.n_failed, " failed, ", info.n_waiting,
               " waiting; the manager was busy for ", hundredths(cpu_seconds() - cpu_before),
               " of ", hundredths(since_start.seconds()), " s"));
  } catch (const StoreBusy& busy) {  // all results are there
    display.note(busy.what());
  }
  store.checkpoint();
  return manager.status();
}

/// What the manager's life came to.
struct ManagerEnd {
  ExitCode status = ExitCode::bug;
  std::string reason;  ///< of a failure, for the user.
  bool in_order = false;
};

ManagerEnd run_manager(Messenger& messenger, const RunOptions& options) {
  ManagerEnd end;
  try {
    end.status = manage(messenger, options, end.in_order);
  } catch (const InputError& error) {
    end = {ExitCode::input, error.what(), false};
  } catch (const StoreBusy& busy) {
    end = {stop_wanted != 0 ? ExitCode::interrupted : ExitCode::world, busy.what(), false};
  } catch (const faultsim::Error& error) {
    end = {ExitCode::world, error.what(), false};
  } catch (const std::bad_alloc&) {
    end = {ExitCode::world, "out of memory", false};
  } catch (const std::exception& error) {  // impossible: unless what was read had been damaged
    const auto damage = Store::damage_of(options.store);
    end = {damage ? ExitCode::world : ExitCode::bug, damage.value_or(error.what()), false};
  }
  return end;
}

ExitCode manager_rank(Messenger& messenger, const RunOptions& options) {
  const ManagerEnd end = run_manager(messenger, options);
  // The starter has the last word, so that nothing of MPI's stands below the reason.
  if (!leave_status(options, end.status, end.reason) && !end.reason.empty())
    std::fprintf(stderr, "faultsweep: %s\n", end.reason.c_str());
  // mpirun, which would be asked by MPI_Abort, is tearing us down already.
  if (torn_down != 0) std::_Exit(static_cast<int>(end.status));
  // Workers leave at once when they are told to, whatever they have under way.
  for (int rank = 1; rank < messenger.size(); ++rank) messenger.send(rank, message::Signal::quit);
  constexpr double kPatience = 10;  // s; an idle worker takes 2 ms, a stopped one for ever
  if (end.in_order) {
    messenger.finish();
  } else if (!messenger.finish(kPatience)) {
    messenger.abort(static_cast<int>(end.status));
  }
  // Under somebody else's mpirun there is no starter to tell.
  return options.status_file.empty() ? end.status : ExitCode::done;
}

std::filesystem::path node_cache(const RunOptions& options) {
  if (options.node_cache.empty()) return default_node_cache(options.store);
  if (options.node_cache == "none") return {};
  return options.node_cache;
}

ExitCode worker_rank(Messenger& messenger, const RunOptions& options) {
  LocalRunner::Options runner_options;
  runner_options.process.binary = options.simulator;
  runner_options.process.cache = std::filesystem::absolute(options.store) / "operators";
  runner_options.process.node_cache = node_cache(options);
  runner_options.host = host_name();
  runner_options.rank = messenger.rank();
  try {
    LocalRunner runner(runner_options);
    run_worker(messenger, runner, runner_options.host, [] { return torn_down != 0; });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "faultsweep: worker %d: %s\n", messenger.rank(), error.what());
    messenger.abort(static_cast<int>(ExitCode::bug));
  }
  if (torn_down != 0) std::_Exit(static_cast<int>(ExitCode::interrupted));
  messenger.finish();
  return ExitCode::done;
}

}  // namespace

std::filesystem::path own_folder_on_disk() {
  std::filesystem::path base = "/tmp";
  for (const char* name : {"TMPDIR", "SLURM_TMPDIR"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && *value != '\0') base = value;
  }
  const long type = file_system_type(base);
  // What lies in tmpfs is memory, and counts as the job's.
  if (type == 0 || type == TMPFS_MAGIC || is_network_file_system(type)) return {};
  std::filesystem::path folder = base / concat("faultsweep-operators-", geteuid());
  mkdir(folder.c_str(), S_IRWXU);
  struct stat info = {};  // others may write in /tmp: they must not give us operators
  const bool is_ours = lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) &&
                       info.st_uid == geteuid() && (info.st_mode & (S_IWGRP | S_IWOTH)) == 0;
  return is_ours ? folder : std::filesystem::path();
}

std::filesystem::path default_node_cache(const std::filesystem::path& store) {
  if (!is_network_file_system(file_system_type(store))) return {};
  return own_folder_on_disk();
}

bool is_rank() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
}

ExitCode run_ranks(int argc, char** argv, const RunOptions& options) {
  set_signals(true);  // before MPI: a SIGUSR1 must not end a rank that is starting
  Messenger messenger(argc, argv);
  set_signals(messenger.rank() == 0);
  if (messenger.size() < 2) {
    throw ResourceError(
        "faultsweep run needs at least 2 ranks: a manager and a worker; start it without mpirun");
  }
  return messenger.rank() == 0 ? manager_rank(messenger, options) : worker_rank(messenger, options);
}

}  // namespace faultsweep
