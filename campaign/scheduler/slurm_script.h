#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "campaign/store/records.h"

namespace faultsweep {

/// What `faultsweep slurm` was asked. Texts go into the script as they are.
struct SlurmRequest {
  int nodes = 1;
  std::optional<int> n_workers;
  std::string time;             ///< as sbatch takes it: "90", "12:00:00"; "" = as predicted.
  std::string memory_per_node;  ///< "16G"; "" = as predicted.
  std::string partition, account;
  int resubmit = 0;  ///< how often the job queues itself again when its time was over.
};

/// What the script is to run. Paths are absolute.
struct SlurmCampaign {
  std::string name;
  std::filesystem::path store, program, simulator;
  std::vector<WaitingFamily> waiting;
};

/// How large a job a campaign needs, from the predictions of its families.
struct SlurmSize {
  int n_workers = 1;
  double seconds = 0;       ///< predicted for all that waits, with these workers.
  double memory_bytes = 0;  ///< of a node.
};
/// Workers (unless asked for): enough to end within kWantedSeconds, at most one per case and
/// kMostWorkers. Memory: of the largest operator while it is built, or, where salt creeps, of one
/// set per worker, and kRankBytes for each rank.
SlurmSize size_of_job(const std::vector<WaitingFamily>& waiting, const SlurmRequest& request);

inline constexpr double kWantedSeconds = 1800;
inline constexpr int kMostWorkers = 15;  ///< with the manager a node of 16 cores.
inline constexpr double kRankBytes = 5e8;
/// Before its time is over a job is told so, s: Slurm may be a minute early or late.
inline constexpr int kSlurmNotice = 120;

/// A script for sbatch that runs the campaign. Throws InputError naming the option whose text
/// cannot stand in a line of it.
std::string slurm_script(const SlurmCampaign& campaign, const SlurmRequest& request);

}  // namespace faultsweep
