#pragma once

#include "campaign/scheduler/ranks.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// `faultsweep run` outside of mpirun: starts itself under mpirun with a manager and n_workers
/// workers, waits, and returns the campaign's status.
///
/// A job that died by a signal (a killed rank ends all of them) is started again, at most
/// kMostRestarts times without a case finished in between; each restart is an event of the
/// campaign. The first Ctrl-C (or SIGTERM, SIGHUP) stops in order: cases under way end and are
/// committed; the second tears the job down; the third kills it. All give exit 75: `faultsweep run`
/// continues. Throws StorageError, InputError before anything is started when the store, the
/// campaign or the simulator is not usable.
faultsim::ExitCode start_ranks(const RunOptions& given);

inline constexpr int kMostRestarts = 3;

/// Whether a run that ended so went through, though some cases may have no full result.
inline bool has_results(faultsim::ExitCode status) {
  return status == faultsim::ExitCode::done || status == faultsim::ExitCode::incomplete;
}

/// Submits to the store and runs that campaign.
struct SubmittedRun {
  std::string campaign;
  faultsim::ExitCode status;
};
SubmittedRun submit_and_run(const Submission& submission, RunOptions options);

}  // namespace faultsweep
