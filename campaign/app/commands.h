#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "campaign/answers/curves.h"
#include "campaign/answers/posterior.h"
#include "campaign/answers/probability.h"
#include "campaign/answers/quantiles.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/answers/tiers.h"
#include "campaign/figures/campaign_figures.h"
#include "campaign/figures/report_page.h"
#include "campaign/nightly/night.h"
#include "campaign/reports/case_report.h"
#include "campaign/reports/compare.h"
#include "campaign/reports/export.h"
#include "campaign/reports/ranking_answer.h"
#include "campaign/scheduler/ranks.h"
#include "campaign/scheduler/slurm_script.h"
#include "simulator/common/exit_code.h"

/// The commands of faultsweep: each prints its data on stdout, its talk on stderr, and returns the
/// exit code. Errors are thrown (common/errors.h).
namespace faultsweep {

using faultsim::ExitCode;

/// Bytes of "20 GB", "500 MB", "0". Throws InputError that names the option.
std::uint64_t parse_size(const std::string& option, const std::string& text);

/// What all commands share.
struct StoreArguments {
  std::filesystem::path store;  ///< --store, FAULTSWEEP_STORE or ./faultsweep-store.
  std::string campaign;         ///< "" = the newest.
  bool json = false;
  std::optional<std::string> csv = std::nullopt;  ///< of an answer, the table of that key as CSV.
};

ExitCode init_command(const std::filesystem::path& folder);
struct SubmitArguments {
  std::string spec;
  bool dry_run = false;
};
ExitCode submit_command(const StoreArguments& common, const SubmitArguments& arguments);
ExitCode run_command(const StoreArguments& common, RunOptions options, int argc, char** argv);
/// Prints a script for sbatch that runs the campaign.
ExitCode slurm_command(const StoreArguments& common, const SlurmRequest& request);
/// The faultsim binary: FAULTSIM_BINARY, or the one beside this program.
std::filesystem::path simulator_binary();
ExitCode status_command(const StoreArguments& common);
/// Whether the store is sound; exit code 4 with all problems and the cure if it is not.
ExitCode verify_store_command(const StoreArguments& common);
ExitCode rank_command(const StoreArguments& common, const RankRequest& request, bool list_metrics);
/// Why a case stands where it does in that ranking. @param name  as of show_command.
ExitCode rank_why_command(const StoreArguments& common, const RankRequest& request,
                          const std::string& name);
struct ProbabilityArguments {
  ProbabilityRequest request = {};
  std::optional<CurveAxis> against = std::nullopt;  ///< curves; none = a table.
  std::string stage = {};                           ///< of curves.
  QuantileRequest quantiles = {};                   ///< with metrics: quantiles instead.
};
ExitCode probability_command(const StoreArguments& common, const ProbabilityArguments& arguments);
ExitCode sensitivity_command(const StoreArguments& common, const SensitivityRequest& request);
ExitCode posterior_command(const StoreArguments& common, const PosteriorRequest& request);

struct TiersArguments {
  std::string source;                                          ///< spec.
  std::vector<std::string> tiers = {"screening", "standard"};  ///< cheap and expensive.
  long budget = 0;                                             ///< samples at the expensive one.
  std::optional<int> n_workers;                                ///< as for `run`.
  TierRequest request;
};
ExitCode tiers_command(const StoreArguments& common, const TiersArguments& arguments);

struct LimitsArguments {
  std::string source;                 ///< a spec (*.json) to submit and run first, or a campaign.
  std::optional<int> n_workers;       ///< of the run; as for `run`.
  long top = 20;                      ///< rows; 0 = all.
  std::vector<std::string> map = {};  ///< two parameters: a table of one against the other instead.
};
/// The code of the run, if there was one.
ExitCode limits_command(const StoreArguments& common, const LimitsArguments& arguments);
struct PillarArguments {
  std::filesystem::path table, scene, folder;
  std::filesystem::path names;        ///< JSON: what the table calls the columns; "" = as we do.
  std::string name;                   ///< of the campaign; "" = that of the table's file.
  std::string stress_azimuth;         ///< "160 deg", of the largest horizontal stress; "" = none.
  std::vector<double> stress_ratios;  ///< largest, smallest.
};
/// Makes a campaign of a table of pillars; submits nothing.
ExitCode pillars_command(const PillarArguments& arguments);
struct MapArguments {
  std::filesystem::path places, output;
};
ExitCode map_command(const StoreArguments& common, const MapArguments& arguments);
/// @param name  case number, beginning of an identity, or CAMPAIGN/either.
ExitCode show_command(const StoreArguments& common, const std::string& name,
                      const ShowRequest& request);
ExitCode explain_command(const StoreArguments& common, const std::string& name);
struct PlotArguments {
  std::string chart;             ///< of case_charts(), or map, sensitivity, probability.
  std::string subject;           ///< campaign, or CAMPAIGN/CASE; "" = the newest campaign.
  std::filesystem::path output;  ///< .svg or .png.
  std::string fault;             ///< of charts of a case; "" = the most critical one.
  std::optional<int> step;       ///< the same; none = the most critical one.
  MapRequest map = {};
  SensitivityRequest sensitivity = {};
  ProbabilityRequest probability = {};
};
/// Draws a chart of a campaign or of one of its cases.
ExitCode plot_command(const StoreArguments& common, const PlotArguments& arguments);
struct ReportArguments {
  std::filesystem::path output;  ///< .html.
  ReportRequest request;
};
/// Writes a campaign as one page.
ExitCode report_command(const StoreArguments& common, const ReportArguments& arguments);
/// Prints the table unless it goes to a file; says on stderr what is in it and what is missing.
ExitCode export_command(const StoreArguments& common, ExportRequest request);
struct CompareArguments {
  std::string a, b;                   ///< campaigns; b "" = of a's name, in the other store.
  std::filesystem::path other_store;  ///< where b is; "" = in the same store.
  CompareRequest request;
};
/// Exit code 5 where something differs or nothing was compared.
ExitCode compare_command(const StoreArguments& common, const CompareArguments& arguments);
struct RetryArguments {
  bool unconverged = false;
  std::optional<long> position;
};
ExitCode retry_command(const StoreArguments& common, const RetryArguments& arguments);
ExitCode cancel_command(const StoreArguments& common);
ExitCode cache_list_command(const StoreArguments& common);
ExitCode cache_verify_command(const StoreArguments& common);
/// @param size  "20 GB", "500 MB", "0".
ExitCode cache_prune_command(const StoreArguments& common, const std::string& size);
/// Runs a night (nightly/night.h). Exit code 5 on any regress, and when nothing was compared.
ExitCode nightly_command(const NightRequest& request, bool json);
/// Prints the nights in the store.
ExitCode nightly_history_command(const std::filesystem::path& store, bool json);
struct TradeoffArguments {
  std::string source;                 ///< a scene, or a campaign spec.
  std::vector<std::string> settings;  ///< "/json/pointer=value" of a scene.
  double wanted_chi = 0.02;           ///< error of χ̄ to recommend a mesh for.
  double operator_seconds = 300;      ///< dearer choices, by prediction, are left out.
  std::string memory;                 ///< the same: "12 GB"; "" = 0.8 of what is available.
  long n_cases = 32;                  ///< of a spec: that are ranked at every tier.
  std::vector<std::string> tiers = {"screening", "standard"};  ///< the last is the reference.
  std::optional<int> n_workers = 1;  ///< one, so that times are not those of two side by side.
  std::filesystem::path output;      ///< folder for report and figures; "" = none.
  bool dry_run = false;
};
/// Measures what the choices of a scene cost, in accuracy and in time (docs/tradeoff.md). The exit
/// code is that of running them: `incomplete` where a choice has no history to its end.
ExitCode tradeoff_command(const StoreArguments& common, const TradeoffArguments& arguments);
ExitCode backup_command(const StoreArguments& common, const std::filesystem::path& target);

}  // namespace faultsweep
