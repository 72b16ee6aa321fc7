#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/scheduler/progress.h"
#include "simulator/common/exit_code.h"

namespace faultsweep {

class Store;
struct CampaignInfo;

/// What `faultsweep run` was asked.
struct RunOptions {
  std::filesystem::path store = {};
  std::string campaign = {};          ///< "" = the newest.
  std::optional<int> n_workers = {};  ///< default: default_workers(), or the slots of the hostfile.
  std::filesystem::path hostfile = {};   ///< mpirun's list of hosts; empty = this one, or Slurm's.
  std::filesystem::path simulator = {};  ///< the faultsim binary.
  /// For operators that are built or held together on one host, bytes, 0 = not limited; default:
  /// 0.9 of what is available to the manager's.
  std::optional<double> memory_bytes = {};
  std::string memory = {};  ///< the same as given: "12 GB".
  /// Threads of building an operator; default: the cores that cases and other builds leave.
  std::optional<int> threads = {};
  /// For copies of operators on each host's own disk; "none", or "" = default_node_cache().
  std::string node_cache = {};
  ProgressDisplay::Style progress = ProgressDisplay::Style::lines;
  /// Adds the campaign's next round to the store; false = there is none. None = one round only.
  std::function<bool(Store&, const std::string& campaign)> next_round = {};
  /// The cases of the campaign that are shown first, by id. None = no fields of such are kept.
  std::function<std::vector<std::int64_t>(const Store&, const CampaignInfo&)> shown_first = {};
  std::filesystem::path status_file =
      {};  ///< of the ranks: where rank 0 leaves the campaign's status.
};

/// Where this host keeps copies of the operators of a store: nowhere ("") if the store is on a
/// local disk; else faultsweep-operators-UID in SLURM_TMPDIR, TMPDIR or /tmp, which it makes,
/// unless that is on the network, in memory, or somebody else's.
std::filesystem::path default_node_cache(const std::filesystem::path& store);
/// The same for a store that is known to be on a network file system.
std::filesystem::path own_folder_on_disk();

/// Bytes of a reason that fit into the status file: "CODE\nREASON\n", then blanks.
inline constexpr std::size_t kLongestReason = 3000;

/// True in a process that mpirun (or srun with PMIx) started as a rank.
bool is_rank();

/// The life of a rank: rank 0 is the manager, the others are workers. The manager's status goes to
/// options.status_file (if any); the process ends with 0 unless it is in trouble itself, as mpirun
/// takes any other code for an accident.
///
/// Signals: SIGUSR1 asks the manager to stop in order (workers ignore it), SIGTERM means that
/// mpirun tears the job down: the manager commits what it has, everybody leaves at once.
faultsim::ExitCode run_ranks(int argc, char** argv, const RunOptions& options);

}  // namespace faultsweep
