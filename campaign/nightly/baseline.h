#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulator/result/result.h"

/// Baselines of `faultsweep nightly`: FOLDER/SUITE/ENVIRONMENT.json (docs/nightly.md).
namespace faultsweep {

/// What `faultsim environment --json` says.
struct Environment {
  std::string fingerprint;
  std::string fields;  ///< JSON object.
  std::string version;
  int numerics_version = 0;
};
Environment environment_from_json(const nlohmann::json& document);
/// "blas_kernel: \"Prescott\" here, \"SkylakeX\" there", one per field that differs.
std::vector<std::string> environment_differences(const Environment& here, const Environment& there);

/// A case of a campaign, of a baseline or of tonight.
struct NightCase {
  long position = 0;
  std::string identity, label;
  std::optional<faultsim::CaseResult> result;  ///< as read from a store; a baseline has it.
  std::string trouble;                         ///< why there is no result.
  std::optional<double> wall_seconds;
};
struct NightCampaign {
  std::string name;
  std::vector<NightCase> cases;
};

/// Why a baseline is what it is.
struct Blessing {
  std::string date;  ///< "2026-11-21".
  std::string reason;
  int numerics_version = 0;
};

struct Baseline {
  std::string suite;
  Environment environment;
  std::vector<Blessing> blessings;  ///< newest last; the file never loses one.
  std::vector<NightCampaign> campaigns;
  const NightCampaign* find(const std::string& campaign) const;
};

std::filesystem::path baseline_path(const std::filesystem::path& folder, const std::string& suite,
                                    const std::string& fingerprint);
/// The baseline of this environment, else the most recently blessed one of another; none = there is
/// none of the suite at all. Throws StorageError, naming the file, when one is damaged or is not
/// what its name says.
std::optional<Baseline> find_baseline(const std::filesystem::path& folder, const std::string& suite,
                                      const Environment& environment);
Baseline read_baseline(const std::filesystem::path& file);
/// Replaces the file at once or not at all.
void write_baseline(const std::filesystem::path& folder, const Baseline& baseline);

/// All numbers of a result that are compared, as text: two results are identical where it is the
/// same.
std::string result_digest(const faultsim::CaseResult& result);

}  // namespace faultsweep
