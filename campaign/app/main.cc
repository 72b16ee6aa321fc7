#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <limits>
#include <map>
#include <new>

#include "campaign/app/options.h"
#include "simulator/common/errors.h"
#include "simulator/common/version.h"

namespace faultsweep {
namespace {

constexpr const char* kFooter =
    "Examples:\n"
    "  faultsweep init my-sweep                      write a starter spec and scene\n"
    "  faultsweep submit my-sweep/campaign.json --dry-run\n"
    "  faultsweep submit my-sweep/campaign.json      check, expand, store\n"
    "  faultsweep run --workers 2                    start, or go on where it stopped\n"
    "  faultsweep run --hostfile hosts               on the hosts of a file, as mpirun takes it\n"
    "  faultsweep slurm --workers 31 --nodes 2 | sbatch      as a job of a cluster\n"
    "  faultsweep status                             from another terminal: time left, failures\n"
    "  faultsweep rank --by moment --where \"friction_angle < 25 deg\" --top 10\n"
    "  faultsweep rank --fault F2 --stage gas_storage --by slip\n"
    "  faultsweep rank --where \"F2.slides in gas_storage and not F1.slides\"\n"
    "  faultsweep show 17                            one case: stages, faults, chi history\n"
    "  faultsweep report -o report.html              all of it on one page, with pictures\n"
    "  faultsweep export -o cases.csv                all cases, for pandas or a spreadsheet\n"
    "  faultsweep compare coarse fine                two campaigns, case by case\n"
    "  faultsweep limits campaign.json               up to which pressure a fault is safe\n"
    "  faultsweep pillars pillars.csv --scene section.json -o pillars     your own faults\n"
    "  faultsweep tradeoff scene.json                what each choice costs, in accuracy and time\n"
    "Campaigns are addressed by name, the newest by default; cases by number, or CAMPAIGN/NUMBER.\n"
    "Exit codes: 0 done, 1 done with some cases without a full result, 2 input, 4 disk or memory,\n"
    "            5 compared and different, or nothing compared, 70 bug,\n"
    "            75 interrupted: run again to continue.";

std::filesystem::path default_store() {
  const char* given = std::getenv("FAULTSWEEP_STORE");
  return given != nullptr && *given != '\0' ? given : "faultsweep-store";
}

void add_running(CLI::App& app, Arguments& a, ExitCode& code, int argc, char** argv) {
  CLI::App* init = app.add_subcommand("init", "write a starter spec and its scene");
  init->add_option("folder", a.init_folder, "where (default ./campaign)");
  init->footer(
      "Example: faultsweep init my-sweep    my-sweep/campaign.json and my-sweep/scene.json");
  init->callback([&] { code = init_command(a.init_folder); });

  CLI::App* submit = app.add_subcommand("submit", "check and expand a spec and store its cases");
  submit->add_option("spec", a.submit.spec, "spec file (JSON)")->required();
  submit->add_flag("--dry-run", a.submit.dry_run, "only show what it would be");
  add_store(submit, a.common);
  add_json(submit, a.common);
  add_wide(submit);
  submit->footer(
      "Examples:\n"
      "  faultsweep submit my-sweep/campaign.json --dry-run    cases, families, time; nothing is "
      "stored\n"
      "  faultsweep submit my-sweep/campaign.json --store runs/store");
  submit->callback([&] { code = submit_command(a.common, a.submit); });

  CLI::App* run = app.add_subcommand("run", "run a campaign, or continue it, under mpirun");
  add_campaign(run, a.common);
  run->add_option("-w,--workers", a.run.n_workers,
                  "workers beside the manager; default: the cores available, or in a Slurm job\n"
                  "its tasks less one")
      ->check(CLI::Range(1, 10000));
  run->add_option("--hostfile", a.run.hostfile,
                  "mpirun's list of hosts; without --workers as many ranks as it has slots")
      ->check(CLI::ExistingFile);
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
                  "of each host, for operators that are built or held together: \"12 GB\",\n"
                  "0 = no limit; default: 0.9 of what is available");
  run->add_option("--threads", a.run.threads,
                  "for building an operator; default: the cores of its host that are idle.\n"
                  "Results are the same with any number")
      ->check(CLI::Range(1, 1024));
  run->add_option("--node-cache", a.run.node_cache,
                  "copies of operators on each host's own disk, or none; default: none if the\n"
                  "store is on a local disk, else a folder in SLURM_TMPDIR, TMPDIR or /tmp");
  run->add_option("--status-file", a.run.status_file)->group("");
  run->footer(
      "Examples:\n"
      "  faultsweep run                       the newest campaign, on all cores\n"
      "  faultsweep run my-sweep --workers 2\n"
      "  faultsweep run --hostfile hosts --memory \"12 GB\"\n"
      "Interrupted, it goes on where it stopped: give the same command again.");
  run->callback([&, argc, argv] { code = run_command(a.common, a.run, argc, argv); });
}

void add_slurm(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* slurm = app.add_subcommand("slurm", "print a script for sbatch that runs a campaign");
  add_campaign(slurm, a.common);
  slurm
      ->add_option("-w,--workers", a.slurm.n_workers,
                   "tasks beside the manager's; default: enough for half an hour, at most 15")
      ->check(CLI::Range(1, 10000));
  slurm->add_option("--nodes", a.slurm.nodes, "default 1")->check(CLI::Range(1, 10000));
  slurm->add_option("--time", a.slurm.time,
                    "as sbatch takes it: 12:00:00; default: twice the time predicted");
  slurm->add_option("--memory-per-node", a.slurm.memory_per_node,
                    "as sbatch takes it: 64G; default: as predicted");
  slurm->add_option("--partition", a.slurm.partition, "default: the cluster's");
  slurm->add_option("--account", a.slurm.account, "default: yours");
  slurm
      ->add_option("--resubmit", a.slurm.resubmit,
                   "how often the job queues itself again when its time was over; default: never")
      ->check(CLI::Range(0, 1000));
  slurm->footer("Example: faultsweep slurm my-sweep --workers 31 --nodes 2 --resubmit 3 | sbatch");
  slurm->callback([&] { code = slurm_command(a.common, a.slurm); });
}

void add_nightly(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* nightly = app.add_subcommand(
      "nightly", "run a suite from scratch and compare it with its baseline, bit for bit");
  NightRequest& n = a.nightly;
  nightly->add_option("suite", n.suite, "suite file (default nightly.json)");
  nightly->add_option("--baselines", n.baselines,
                      "folder of the baselines (default results/baselines)");
  nightly->add_option("--store", n.store, "store of the nights (default ./faultsweep-nightly)");
  nightly->add_option("-w,--workers", n.n_workers, "as for run")->check(CLI::Range(1, 10000));
  CLI::Option* bless = nightly->add_flag("--bless", n.bless, "make tonight's results the baseline");
  CLI::Option* reason = nightly->add_option("--reason", n.reason, "why; kept in the baseline");
  bless->needs(reason);
  reason->needs(bless);
  nightly->add_flag("--history", a.nightly_history, "only print the nights so far")
      ->excludes(bless);
  nightly->add_flag("--json", a.nightly_json, "machine-readable output on stdout");
  add_wide(nightly);
  nightly->footer(
      "Examples:\n"
      "  faultsweep nightly nightly.json\n"
      "  faultsweep nightly --bless --reason \"finer cells at the corners\"\n"
      "Exit codes: 0 no regress, 5 a regress, or nothing was compared.");
  nightly->callback([&] {
    code = a.nightly_history ? nightly_history_command(n.store, a.nightly_json)
                             : nightly_command(n, a.nightly_json);
  });
}

void add_tradeoff(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* command = app.add_subcommand(
      "tradeoff", "measure on a scene what each choice costs in accuracy and in time");
  TradeoffArguments& t = a.tradeoff;
  command->add_option("source", t.source, "scene, or campaign spec (JSON)")->required();
  command->add_option("--set", t.settings, "/json/pointer=value of the scene");
  command
      ->add_option("--error", t.wanted_chi,
                   "of the critical index, to recommend a mesh for (default 0.02)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--operator-limit", t.operator_seconds,
                   "s; choices whose operator is predicted to take longer are left out\n"
                   "(default 300)")
      ->check(CLI::PositiveNumber);
  command->add_option("--memory", t.memory,
                      "the same for memory: \"12 GB\"; default: 0.8 of what is available");
  command
      ->add_option("--cases", t.n_cases, "of a spec: how many are ranked at each tier (default 32)")
      ->check(CLI::Range(2, 100000));
  command
      ->add_option("--tiers", t.tiers,
                   "with commas, the last is the reference (default screening,standard)")
      ->delimiter(',');
  command->add_option("-w,--workers", t.n_workers, "default 1: two disturb each other's times")
      ->check(CLI::Range(1, 10000));
  command->add_option("-o,--output", t.output, "folder for report.md, trade.json and figures");
  command->add_flag("--dry-run", t.dry_run, "only show the choices and their predicted cost");
  add_store(command, a.common);
  add_json(command, a.common);
  add_wide(command);
  command->footer(
      "Examples:\n"
      "  faultsweep tradeoff scene.json --dry-run\n"
      "  faultsweep tradeoff scene.json --error 0.01 -o trade\n"
      "  faultsweep tradeoff campaign.json --cases 16 --tiers screening,demonstration\n"
      "Interrupted, it goes on where it stopped: give the same command again.");
  command->callback([&] { code = tradeoff_command(a.common, t); });
}

void add_caring(CLI::App& app, Arguments& a, ExitCode& code) {
  CLI::App* retry = app.add_subcommand("retry", "let failed cases run again");
  add_campaign(retry, a.common);
  retry->add_option("--case", a.retry.position, "only this case number");
  retry->add_flag("--unconverged", a.retry.unconverged, "also cases whose history ended early");
  add_json(retry, a.common);
  retry->footer(
      "Examples:\n"
      "  faultsweep retry my-sweep\n"
      "  faultsweep retry --case 17 --unconverged");
  retry->callback([&] { code = retry_command(a.common, a.retry); });

  CLI::App* cancel = app.add_subcommand("cancel", "hand out no more cases of a campaign");
  add_campaign(cancel, a.common);
  add_json(cancel, a.common);
  cancel->footer(
      "Example: faultsweep cancel my-sweep    results stay; submit the spec again to reopen it");
  cancel->callback([&] { code = cancel_command(a.common); });

  CLI::App* cache = app.add_subcommand("cache", "the operators kept in STORE/operators");
  cache->footer("Example: faultsweep cache list");
  cache->require_subcommand(1);
  CLI::App* list = cache->add_subcommand("list", "operators, most recently used first");
  add_store(list, a.common);
  add_json(list, a.common);
  list->footer("Example: faultsweep cache list --json");
  list->callback([&] { code = cache_list_command(a.common); });
  CLI::App* verify =
      cache->add_subcommand("verify", "checksums of the operators and integrity of the store");
  add_store(verify, a.common);
  add_json(verify, a.common);
  verify->footer("Example: faultsweep cache verify --store runs/store");
  verify->callback([&] { code = cache_verify_command(a.common); });
  CLI::App* prune = cache->add_subcommand("prune", "remove least recently used operators");
  prune->add_option("--max-size", a.cache_size, "what may stay (default 20 GB)");
  add_store(prune, a.common);
  add_json(prune, a.common);
  prune->footer("Example: faultsweep cache prune --max-size \"5 GB\"");
  prune->callback([&] { code = cache_prune_command(a.common, a.cache_size); });

  CLI::App* backup =
      app.add_subcommand("backup", "copy the store's database, also while it is in use");
  backup->add_option("file", a.backup_target, "new file")->required();
  add_store(backup, a.common);
  backup->footer("Example: faultsweep backup before.sqlite");
  backup->callback([&] { code = backup_command(a.common, a.backup_target); });
}

/// Reads the command line and returns the chosen command's exit code.
ExitCode faultsweep_main(int argc, char** argv) {
  CLI::App app{"faultsweep: campaigns of fault reactivation cases", "faultsweep"};
  app.require_subcommand(1);
  app.get_formatter()->column_width(24);  // texts of up to 76 columns stand beside it
  app.footer(kFooter);
  app.set_version_flag("--version", faultsim::version_text("faultsweep"));
  Arguments arguments;
  arguments.common.store = default_store();
  ExitCode code = ExitCode::done;
  add_running(app, arguments, code, argc, argv);
  add_slurm(app, arguments, code);
  add_answers(app, arguments, code);
  add_nightly(app, arguments, code);
  add_tradeoff(app, arguments, code);
  add_caring(app, arguments, code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::input;
  } catch (const faultsim::Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // impossible: unless what was read had been damaged
    for (const auto& store : {arguments.common.store, arguments.compare.other_store,
                              std::filesystem::path(arguments.nightly.store)}) {
      if (store.empty()) continue;
      if (const auto damage = Store::damage_of(store)) throw faultsim::StorageError(*damage);
    }
    throw;
  }
  return code;
}

}  // namespace
}  // namespace faultsweep

int main(int argc, char** argv) {
  return static_cast<int>(
      faultsim::run_program("faultsweep", faultsweep::faultsweep_main, argc, argv));
}
