#include "campaign/scheduler/slurm_script.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/names.h"
#include "campaign/scheduler/resources.h"

namespace faultsweep {
namespace {

/// Seconds of a case that nobody has run yet; where salt creeps it has many time steps.
double guessed_case_seconds(const FamilyRecord& family) {
  return family.creeps() ? std::max(60.0, family.operator_seconds) : 1.0;
}

double case_seconds(const WaitingFamily& family) {
  return static_cast<double>(family.cases.size()) *
         family.seconds_per_case.value_or(guessed_case_seconds(family.predicted));
}

/// Only letters, digits and what times, sizes and names of partitions are made of.
void require_plain(const char* option, const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string("-_.,:+@").find(static_cast<char>(c)) != std::string::npos;
  };
  if (std::ranges::all_of(text, is_plain)) return;
  throw InputError(option, concat("\"", text, "\" is not allowed in a line for sbatch"),
                   "write it as for sbatch: 12:00:00, 16G, batch");
}

/// One word for the shell.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// Twice the prediction, which is another machine's, and 10 min; in steps of 10 min.
std::string asked_time(double seconds) {
  constexpr double kStep = 600;
  const long minutes = std::lround(kStep / 60 * (1 + std::ceil(2 * seconds / kStep)));
  return formatted("%02ld:%02ld:00", minutes / 60, minutes % 60);
}

std::string asked_memory(double bytes) {
  constexpr double kMegabyte = 1024 * 1024, kStep = 100;
  return concat(std::lround(kStep * std::ceil(bytes / kMegabyte / kStep)), "M");
}

std::string head(const SlurmCampaign& campaign, const SlurmRequest& request) {
  const SlurmSize size = size_of_job(campaign.waiting, request);
  long n_cases = 0;
  for (const WaitingFamily& family : campaign.waiting)
    n_cases += static_cast<long>(family.cases.size());
  std::string text = concat(
      "#!/bin/bash\n# Runs the campaign ", campaign.name,
      ", or what is left of it; printed by `faultsweep slurm`.\n#SBATCH --job-name=", campaign.name,
      "\n# The manager, which is mostly idle, and ", counted(size.n_workers, "worker", "workers"),
      " for ", counted(n_cases, "case", "cases"), " in ",
      counted(campaign.waiting.size(), "family", "families"), ".\n#SBATCH --nodes=", request.nodes,
      "\n#SBATCH --ntasks=", size.n_workers + 1, "\n");
  if (request.time.empty()) {
    text +=
        concat("# Twice the ", std::lround(std::ceil(size.seconds / 60)),
               " min predicted, plus 10 min. What is not done by then is left to the next job.\n");
  }
  text += concat("#SBATCH --time=", request.time.empty() ? asked_time(size.seconds) : request.time,
                 "\n");
  if (request.memory_per_node.empty()) {
    text +=
        "# Per node: to build the largest operator (where salt creeps, for one set per "
        "worker), and\n"
        "# 0.5 GB for each rank. Operators that do not fit at once are built one after the "
        "other.\n";
  }
  text += concat(
      "#SBATCH --mem=",
      request.memory_per_node.empty() ? asked_memory(size.memory_bytes) : request.memory_per_node,
      "\n");
  if (!request.partition.empty()) text += concat("#SBATCH --partition=", request.partition, "\n");
  if (!request.account.empty()) text += concat("#SBATCH --account=", request.account, "\n");
  text += concat(
      "# SIGUSR1 to this shell ", kSlurmNotice,
      " s before the time is up: cases in progress are committed, exit code 75.\n"
      "#SBATCH --signal=B:USR1@",
      kSlurmNotice,
      "\n# After a node failure or a preemption the job is queued again and continues where it "
      "stopped, in\n# the same log.\n#SBATCH --requeue\n#SBATCH --open-mode=append\n"
      "#SBATCH --output=",
      campaign.name, "-%j.log\n");
  return text;
}

}  // namespace

SlurmSize size_of_job(const std::vector<WaitingFamily>& waiting, const SlurmRequest& request) {
  SlurmSize size;
  double seconds = 0, longest_build = 0, largest = 0, largest_creeping = 0;
  std::size_t n_cases = 0;
  for (const WaitingFamily& family : waiting) {
    const FamilyRecord& predicted = family.predicted;
    n_cases += family.cases.size();
    seconds += predicted.operator_seconds + case_seconds(family);
    longest_build = std::max(longest_build, predicted.operator_seconds);
    largest = std::max(largest, predicted.memory_bytes);
    if (predicted.creeps()) largest_creeping = std::max(largest_creeping, predicted.memory_bytes);
  }
  const double useful = std::min(std::ceil(seconds / kWantedSeconds), static_cast<double>(n_cases));
  size.n_workers =
      request.n_workers.value_or(static_cast<int>(std::clamp(useful, 1.0, double{kMostWorkers})));
  size.seconds = longest_build + seconds / size.n_workers;
  const int ranks_on_node = (size.n_workers + request.nodes) / request.nodes;  // rounded up
  const double operators =
      std::max(largest, largest_creeping * std::min(ranks_on_node, size.n_workers));
  size.memory_bytes = operators / kMemoryShare + kRankBytes * ranks_on_node;
  return size;
}

std::string slurm_script(const SlurmCampaign& campaign, const SlurmRequest& request) {
  require_plain("--time", request.time);
  require_plain("--memory-per-node", request.memory_per_node);
  require_plain("--partition", request.partition);
  require_plain("--account", request.account);
  std::string text = head(campaign, request);
  text += concat(
      "\n# faultsweep starts mpirun, which uses the hosts of the job; workers are its tasks less "
      "one.\n",
      quoted(campaign.program.string()), " run ", campaign.name, " --store ",
      quoted(campaign.store.string()), " --simulator ", quoted(campaign.simulator.string()),
      " --progress lines &\nrun=$!\n"
      "# Slurm signals only this shell, which passes it on. A signal ends `wait`, but not the "
      "run.\n"
      "time_is_over=no signalled=yes\n"
      "trap 'time_is_over=yes signalled=yes; kill -USR1 $run' USR1\n"
      "trap 'signalled=yes; kill -TERM $run' TERM\n"
      "while [ $signalled = yes ]; do signalled=no; wait $run; status=$?; done\n");
  if (request.resubmit > 0) {
    text += concat(
        "# 75: some cases are left. Queue this job again, at most ",
        counted(request.resubmit, "time", "times"),
        " (Slurm counts).\n"
        "if [ $status -eq 75 ] && [ $time_is_over = yes ] && [ \"${SLURM_RESTART_COUNT:-0}\" -lt ",
        request.resubmit, " ]; then\n  scontrol requeue \"$SLURM_JOB_ID\"\nfi\n");
  }
  return text + "exit $status\n";
}

}  // namespace faultsweep
