#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "campaign/store/records.h"

namespace faultsweep {

/// What `faultsweep nightly` was asked.
struct NightRequest {
  std::string suite = "nightly.json";
  std::filesystem::path baselines = "results/baselines";
  std::filesystem::path store =
      "faultsweep-nightly";  ///< of the nights, and of the last one's run.
  std::optional<int> n_workers;
  bool bless = false;
  std::string reason;  ///< of bless.
};
/// The programs that run it.
struct NightPrograms {
  std::filesystem::path simulator;  ///< faultsim; faultsim-verify stands beside it.
  std::string version;              ///< of faultsweep.
};
struct NightOutcome {
  NightRecord record;
  std::vector<std::string> remarks;  ///< on environment and baseline.
  std::vector<std::string> advice;   ///< night_advice.
};

inline constexpr int kNightsShown = 50;

/// Runs a suite from scratch, compares it with its baseline, which it becomes if it is to be
/// blessed, and records the night in its store (docs/nightly.md). Nothing, and why on stderr, when
/// there is nothing to compare with. Throws StorageError where another night works in the store,
/// InputError and ResourceError where the suite cannot be run, Interrupted.
std::optional<NightOutcome> run_night(const NightRequest& request, const NightPrograms& programs);

}  // namespace faultsweep
