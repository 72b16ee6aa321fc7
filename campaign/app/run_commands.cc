#include <unistd.h>

#include <cstdlib>

#include "campaign/app/commands.h"
#include "campaign/query/ranking.h"
#include "campaign/rounds/next_round.h"
#include "campaign/scheduler/ranks.h"
#include "campaign/scheduler/slurm_script.h"
#include "campaign/scheduler/starter.h"
#include "campaign/store/store.h"

namespace faultsweep {

std::filesystem::path simulator_binary() {
  if (const char* given = std::getenv("FAULTSIM_BINARY")) return std::filesystem::absolute(given);
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "faultsim";
}

namespace {

struct RunArguments : RunOptions {
  int argc = 0;
  char** argv = nullptr;
};

ExitCode run(const StoreArguments& common, const RunArguments& arguments) {
  RunOptions options = arguments;
  options.store = common.store;
  options.campaign = common.campaign;
  if (options.simulator.empty()) options.simulator = simulator_binary();
  options.next_round = add_next_round;
  options.shown_first = [](const Store& store, const CampaignInfo& campaign) {
    return cases_ranked_first(store, campaign);
  };
  if (is_rank()) return run_ranks(arguments.argc, arguments.argv, options);
  const ExitCode status = start_ranks(options);
  const std::string name = Store::open_reader(common.store).campaign(options.campaign).name;
  switch (status) {
    case ExitCode::done:
    case ExitCode::incomplete:
      say("Next: faultsweep rank ", name, " --store ", common.store.string());
      break;
    case ExitCode::interrupted:
      say("Interrupted; nothing is lost. Next: faultsweep run ", name, " --store ",
          common.store.string());
      break;
    default:
      break;
  }
  return status;
}

ExitCode slurm(const StoreArguments& common, const SlurmRequest& request) {
  const Store store = Store::open_reader(common.store);
  const CampaignInfo campaign = store.campaign(common.campaign, false);
  SlurmCampaign job;
  job.name = campaign.name;
  job.store = std::filesystem::absolute(common.store).lexically_normal();
  job.program = std::filesystem::read_symlink("/proc/self/exe");
  job.simulator = simulator_binary();
  job.waiting = store.waiting_families(campaign.id);
  print_text(slurm_script(job, request));
  if (job.waiting.empty()) {
    say("No case is waiting in ", campaign.name);
  } else {
    say("Next: faultsweep slurm ", campaign.name, " ... | sbatch");
  }
  return ExitCode::done;
}

}  // namespace

void add_running(Program& program, int argc, char** argv) {
  auto [command, a] = program.add("run", "run a campaign, or continue it, under mpirun", run);
  a.argc = argc, a.argv = argv;
  add_campaign(command, program.common);
  add_workers(command, a.n_workers,
              "workers besides the manager; default: the cores available, or in a Slurm\n"
              "job its tasks less one");
  command
      ->add_option("--hostfile", a.hostfile,
                   "mpirun's list of hosts; without --workers, as many ranks as it has slots")
      ->check(CLI::ExistingFile);
  a.progress =
      isatty(STDERR_FILENO) != 0 ? ProgressDisplay::Style::bar : ProgressDisplay::Style::lines;
  command
      ->add_option_function<std::string>(
          "--progress",
          [&run_arguments = a](const std::string& word) {
            run_arguments.progress = *named<ProgressDisplay::Style>(word);
          },
          "none, lines or bar; default: bar on a terminal")
      ->check(CLI::IsMember({"none", "lines", "bar"}));
  command->add_option("--simulator", a.simulator,
                      "the faultsim binary; default FAULTSIM_BINARY, or beside faultsweep");
  add_build_limits(command, a);
  command->add_option("--node-cache", a.node_cache,
                      "copies of operators on each host's own disk, or none; default: none if the\n"
                      "store is on a local disk, else a folder in SLURM_TMPDIR, TMPDIR or /tmp");
  command->add_option("--status-file", a.status_file)->group("");
  command->footer(
      "Examples:\n"
      "  faultsweep run                       the newest campaign, on all cores\n"
      "  faultsweep run my-sweep --workers 2\n"
      "  faultsweep run --hostfile hosts --memory \"12 GB\"\n"
      "If interrupted, give the same command again: it continues where it stopped.");

  auto [slurm_command, request] =
      program.add("slurm", "print a script for sbatch that runs a campaign", slurm);
  add_campaign(slurm_command, program.common);
  add_workers(slurm_command, request.n_workers,
              "tasks besides the manager's; default: enough for half an hour, at most 15");
  slurm_command->add_option("--nodes", request.nodes, "default 1")->check(CLI::Range(1, 10000));
  slurm_command->add_option(
      "--time", request.time,
      "as for sbatch: 12:00:00; default: twice the predicted time, plus 10 min");
  slurm_command->add_option("--memory-per-node", request.memory_per_node,
                            "as for sbatch: 64G; default: as predicted");
  slurm_command->add_option("--partition", request.partition, "default: the cluster's");
  slurm_command->add_option("--account", request.account, "default: yours");
  slurm_command
      ->add_option("--resubmit", request.resubmit,
                   "how often the job queues itself again when its time is up; default: never")
      ->check(CLI::Range(0, 1000));
  slurm_command->footer(
      "Example: faultsweep slurm my-sweep --workers 31 --nodes 2 --resubmit 3 | sbatch");
}

}  // namespace faultsweep
