#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "campaign/scheduler/progress.h"
#include "simulator/common/exit_code.h"

namespace faultsweep {

/// What `faultsweep run` was asked.
struct RunOptions {
  std::filesystem::path store;
  std::string campaign;             ///< "" = the newest.
  std::optional<int> n_workers;     ///< default: available_cores().
  std::filesystem::path simulator;  ///< the faultsim binary.
  /// For operators that are built or held together, bytes, 0 = not limited; default: 0.9 of what is
  /// available.
  std::optional<double> memory_bytes;
  std::string memory;  ///< the same as given: "12 GB".
  ProgressDisplay::Style progress = ProgressDisplay::Style::lines;
  std::filesystem::path status_file;  ///< of the ranks: where rank 0 leaves the campaign's status.
};

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
