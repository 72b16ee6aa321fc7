#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "campaign/common/names.h"
#include "campaign/render/answer.h"
#include "campaign/scheduler/ranks.h"
#include "campaign/store/store.h"
#include "simulator/common/exit_code.h"

/// The commands of faultsweep: each prints its data on stdout, its talk on stderr, and returns the
/// exit code. Errors are thrown (common/errors.h).
namespace faultsweep {

/// What all commands share.
struct StoreArguments {
  std::filesystem::path store;  ///< --store, FAULTSWEEP_STORE or ./faultsweep-store.
  std::string campaign;         ///< "" = the newest.
  bool json = false;
  std::optional<std::string> csv = std::nullopt;  ///< of an answer, the table of that key as CSV.
};

/// The command line, to which commands add themselves.
struct Program {
  CLI::App app{"faultsweep: campaigns of fault reactivation cases", "faultsweep"};
  StoreArguments common;
  std::vector<const std::filesystem::path*> stores = {&common.store};  ///< that commands open.
  ExitCode code = ExitCode::done;  ///< of the command that was given.

  /// A command with arguments of its own, which its options are to fill; `run` gets them where it
  /// is given.
  template <typename Arguments>
  std::pair<CLI::App*, Arguments&> add(const char* name, const char* description,
                                       ExitCode (*run)(const StoreArguments&, const Arguments&),
                                       CLI::App* parent = nullptr) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = (parent != nullptr ? parent : &app)->add_subcommand(name, description);
    command->callback([this, run, arguments] { code = run(common, *arguments); });
    return {command, *arguments};
  }
  /// One without. @param parent  whose subcommand it is; null = the program's.
  CLI::App* add(const char* name, const char* description, ExitCode (*run)(const StoreArguments&),
                CLI::App* parent = nullptr) {
    CLI::App* command = (parent != nullptr ? parent : &app)->add_subcommand(name, description);
    command->callback([this, run] { code = run(common); });
    return command;
  }
};

/// Commands in groups, in the order in which the help lists them.
void add_submitting(Program& program);                      ///< init, submit.
void add_running(Program& program, int argc, char** argv);  ///< run, slurm.
void add_reading(Program& program);                         ///< status, rank, show, explain.
void add_samples(Program& program);  ///< probability, posterior, sensitivity.
void add_tiers(Program& program);
void add_pictures(Program& program);  ///< plot, report.
void add_serving(Program& program);
void add_sheet(Program& program);
void add_limits(Program& program);
void add_pillars(Program& program);  ///< pillars, map.
void add_tables(Program& program);   ///< export, compare.
void add_nightly(Program& program);
void add_tradeoff(Program& program);
void add_caring(Program& program);  ///< retry, cancel, cache, backup.

/// Options that several commands have.
void add_store(CLI::App* command, StoreArguments& common);
void add_campaign(CLI::App* command, StoreArguments& common);
void add_case(CLI::App* command, StoreArguments& common, std::string& name);
void add_where(CLI::App* command, std::string& where);
void add_stage_and_fault(CLI::App* command, std::string& stage, std::string& fault);
void add_json(CLI::App* command, StoreArguments& common);
void add_wide(CLI::App* command);
/// The renderings of an answer.
void add_renderings(CLI::App* command, StoreArguments& common);
void add_confidence(CLI::App* command, double& confidence);
/// Refuses NaN, which CLI::Range, PositiveNumber and NonNegativeNumber let pass.
CLI::Validator not_nan();
void add_workers(CLI::App* command, std::optional<int>& n_workers, const char* description);
/// Memory and threads for building operators.
void add_build_limits(CLI::App* command, RunOptions& options);

/// Data, on stdout.
void print_text(const std::string& text);
void print_json(const nlohmann::json& document);
/// A line of talk, on stderr.
template <typename... Parts>
void say(const Parts&... parts) {
  std::fputs(faultsim::concat(parts..., '\n').c_str(), stderr);
}
/// Prints the answer on stdout: as text at the width of the screen, as JSON or one of its tables as
/// CSV. Throws InputError where there is no such table.
void print_answer(const Answer& answer, const StoreArguments& common);

/// Columns of the terminal that stdout is; else those of COLUMNS, or kScreenWidth.
std::size_t screen_width();
/// What screen_width() gives from now on: --wide asks for one without end.
void set_screen_width(std::size_t width);

/// A case addressed as CASE or CAMPAIGN/CASE.
struct NamedCase {
  CampaignInfo campaign;
  StoredCase stored;
};
/// @param campaign  where the name has none; "" = the newest.
NamedCase find_case(const Store& store, const std::string& campaign, const std::string& name);

/// Bytes of "20 GB", "500 MB", "0". Throws InputError that names the option.
std::uint64_t parse_size(const std::string& option, const std::string& text);
/// The faultsim binary: FAULTSIM_BINARY, or the one beside this program.
std::filesystem::path simulator_binary();

}  // namespace faultsweep
