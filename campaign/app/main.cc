#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <map>

#include "campaign/app/commands.h"
#include "simulator/common/errors.h"

namespace faultsweep {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  faultsweep init my-sweep                      write a starter spec and scene\n"
    "  faultsweep submit my-sweep/campaign.json --dry-run\n"
    "  faultsweep submit my-sweep/campaign.json      check, expand, store\n"
    "  faultsweep run --workers 2                    start, or go on where it stopped\n"
    "  faultsweep status                             from another terminal: time left, failures\n"
    "  faultsweep rank --by moment --where \"friction_angle < 25 deg\" --top 10\n"
    "  faultsweep show 17                            one case: stages, chi history per fault\n"
    "Campaigns are addressed by name, the newest by default; cases by number, or CAMPAIGN/NUMBER.\n"
    "Exit codes: 0 done, 1 done with some cases without a full result, 2 input, 4 disk or memory,\n"
    "            70 bug, 75 interrupted: run again to continue.";

std::filesystem::path default_store() {
  const char* given = std::getenv("FAULTSWEEP_STORE");
  return given != nullptr && *given != '\0' ? given : "faultsweep-store";
}

void add_store(CLI::App* command, StoreArguments& common) {
  command->add_option("--store", common.store,
                      "store folder (default FAULTSWEEP_STORE or ./faultsweep-store)");
}
void add_campaign(CLI::App* command, StoreArguments& common) {
  command->add_option("campaign", common.campaign, "its name; default: the newest");
  add_store(command, common);
}
void add_case(CLI::App* command, StoreArguments& common, std::string& name) {
  command->add_option("case", name, "number, beginning of its identity, or CAMPAIGN/either")
      ->required();
  command->add_option("--campaign", common.campaign, "default: the newest");
  add_store(command, common);
}
void add_json(CLI::App* command, StoreArguments& common) {
  command->add_flag("--json", common.json, "machine-readable output on stdout");
}

/// All arguments of all commands; CLI11 fills them.
struct Arguments {
  StoreArguments common;
  std::string init_folder = "campaign", case_name, cache_size = "20 GB", backup_target;
  SubmitArguments submit;
  RunOptions run;
  RankRequest rank;
  bool list_metrics = false;
  RetryArguments retry;
};

void add_running(CLI::App& app, Arguments& a, ExitCode& code, int argc, char** argv) {
  CLI::App* init = app.add_subcommand("init", "write a starter spec and its scene");
  init->add_option("folder", a.init_folder, "where (default ./campaign)");
  init->callback([&] { code = init_command(a.init_folder); });

  CLI::App* submit = app.add_subcommand("submit", "check and expand a spec and store its cases");
  submit->add_option("spec", a.submit.spec, "spec file (JSON)")->required();
  submit->add_flag("--dry-run", a.submit.dry_run, "only show what it would be");
  add_store(submit, a.common);
  add_json(submit, a.common);
  submit->callback([&] { code = submit_command(a.common, a.submit); });

  CLI::App* run = app.add_subcommand("run", "run a campaign, or continue it, under mpirun");
  add_campaign(run, a.common);
  run->add_option("-w,--workers", a.run.n_workers,
                  "workers beside the manager; default: the cores available")
      ->check(CLI::Range(1, 10000));
  const std::map<std::string, ProgressDisplay::Style> styles = {
      {"none", ProgressDisplay::Style::silent},
      {"lines", ProgressDisplay::Style::lines},
      {"bar", ProgressDisplay::Style::bar}};
  a.run.progress =
      isatty(STDERR_FILENO) != 0 ? ProgressDisplay::Style::bar : ProgressDisplay::Style::lines;
  run->add_option("--progress", a.run.progress, "none, lines or bar; default: bar on a terminal")
      ->transform(CLI::CheckedTransformer(styles));
  run->add_option("--simulator", a.run.simulator,
                  "the faultsim binary; default FAULTSIM_BINARY, or beside faultsweep");
  run->add_option("--memory", a.run.memory,
                  "for operators that are built or held together: \"12 GB\", 0 = no limit;\n"
                  "default: 0.9 of what is available");
  run->add_option("--status-file", a.run.status_file)->group("");
  run->callback([&, argc, argv] { code = run_command(a.common, a.run, argc, argv); });
}

void add_reading(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* status =
      app.add_subcommand("status", "how a campaign stands: counts, time left, failures");
  add_campaign(status, a.common);
  add_json(status, a.common);
  status->callback([&] { code = status_command(a.common); });

  CLI::App* rank = app.add_subcommand("rank", "the riskiest configurations first");
  add_campaign(rank, a.common);
  rank->add_option(
      "--by", a.rank.by,
      "metric or expression; default: the spec's, or activated area, then M0, then the\n"
      "pressure margin of inactive cases, then chi");
  rank->add_option("--stage", a.rank.stage, "metrics of this stage; default: the whole history");
  rank->add_option("--where", a.rank.where,
                   "condition on metrics and parameters: \"offset > 50 m and activated\"");
  rank->add_option("--top", a.rank.top, "how many rows; 0 = all")->check(CLI::NonNegativeNumber);
  rank->add_flag("--ascending", a.rank.ascending, "smallest first");
  rank->add_flag("--list-metrics", a.list_metrics, "what can be ranked by");
  add_json(rank, a.common);
  rank->callback([&] { code = rank_command(a.common, a.rank, a.list_metrics); });

  CLI::App* show =
      app.add_subcommand("show", "one case: parameters, outcome, stages, slip events, chi history");
  add_case(show, a.common, a.case_name);
  add_json(show, a.common);
  show->callback([&] { code = show_command(a.common, a.case_name); });

  CLI::App* explain = app.add_subcommand("explain", "why a case will run, or will not");
  add_case(explain, a.common, a.case_name);
  explain->callback([&] { code = explain_command(a.common, a.case_name); });
}

void add_caring(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* retry = app.add_subcommand("retry", "let failed cases run again");
  add_campaign(retry, a.common);
  retry->add_option("--case", a.retry.position, "only this case number");
  retry->add_flag("--unconverged", a.retry.unconverged, "also cases whose history ended early");
  retry->callback([&] { code = retry_command(a.common, a.retry); });

  CLI::App* cancel = app.add_subcommand("cancel", "hand out no more cases of a campaign");
  add_campaign(cancel, a.common);
  cancel->callback([&] { code = cancel_command(a.common); });

  CLI::App* cache = app.add_subcommand("cache", "the operators kept in STORE/operators");
  cache->require_subcommand(1);
  CLI::App* list = cache->add_subcommand("list", "operators, most recently used first");
  add_store(list, a.common);
  add_json(list, a.common);
  list->callback([&] { code = cache_list_command(a.common); });
  CLI::App* verify =
      cache->add_subcommand("verify", "checksums of the operators and integrity of the store");
  add_store(verify, a.common);
  verify->callback([&] { code = cache_verify_command(a.common); });
  CLI::App* prune = cache->add_subcommand("prune", "remove least recently used operators");
  prune->add_option("--max-size", a.cache_size, "what may stay (default 20 GB)");
  add_store(prune, a.common);
  prune->callback([&] { code = cache_prune_command(a.common, a.cache_size); });

  CLI::App* backup =
      app.add_subcommand("backup", "copy the store's database, also while it is in use");
  backup->add_option("file", a.backup_target, "new file")->required();
  add_store(backup, a.common);
  backup->callback([&] { code = backup_command(a.common, a.backup_target); });
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsweep_main(int argc, char** argv) {
  CLI::App app{"faultsweep: campaigns of fault reactivation cases", "faultsweep"};
  app.require_subcommand(1);
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("faultsweep ") + FAULTSIM_VERSION);
  Arguments arguments;
  arguments.common.store = default_store();
  ExitCode code = ExitCode::done;
  add_running(app, arguments, code, argc, argv);
  add_reading(app, arguments, code);
  add_caring(app, arguments, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::input;
  }
  return code;
}

}  // namespace
}  // namespace faultsweep

int main(int argc, char** argv) {
  return static_cast<int>(
      faultsim::run_program("faultsweep", faultsweep::faultsweep_main, argc, argv));
}
