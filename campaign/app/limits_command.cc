#include <filesystem>

#include "campaign/answers/limit_table.h"
#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/expansion/submission.h"
#include "campaign/rounds/next_round.h"
#include "campaign/scheduler/starter.h"

namespace faultsweep {

namespace {

struct LimitsArguments {
  std::string source;                 ///< a spec (*.json) to submit and run first, or a campaign.
  std::optional<int> n_workers;       ///< of the run; as for `run`.
  long top = 20;                      ///< rows; 0 = all.
  std::vector<std::string> map = {};  ///< two parameters: a table of one against the other instead.
};

/// Submits a spec and searches its limits.
SubmittedRun search_limits(const StoreArguments& common, const LimitsArguments& arguments) {
  const Expansion expansion = expand(read_campaign(arguments.source));
  if (expansion.spec.limits.empty()) {
    throw InputError(arguments.source, {{"/limits", 0, "the spec does not search for limits",
                                         "add a section \"limits\", or use faultsweep submit"}});
  }
  check_rounds(expansion);
  return submit_and_run(
      make_submission(expansion),
      {.store = common.store, .n_workers = arguments.n_workers, .simulator = simulator_binary()});
}

/// The code of the run, if there was one.
ExitCode limits(const StoreArguments& common, const LimitsArguments& arguments) {
  SubmittedRun run{arguments.source, ExitCode::done};
  if (std::filesystem::path(run.campaign).extension() == ".json") {
    run = search_limits(common, arguments);
    if (!has_results(run.status)) return run.status;
  }
  const Store store = Store::open_reader(common.store);
  const LimitTable table = make_limit_table(store, store.campaign(run.campaign));
  print_answer(arguments.map.empty() ? to_answer(table, arguments.top)
                                     : map_answer(table, arguments.map.at(0), arguments.map.at(1)),
               common);
  if (!table.is_finished) {
    say("Next: faultsweep run ", table.campaign.name, " --store ", common.store.string());
  }
  return run.status;
}

}  // namespace

void add_limits(Program& program) {
  auto [command, a] = program.add(
      "limits", "up to which pressure a fault is safe, in each configuration of a spec", limits);
  command->add_option(
      "source", a.source,
      "spec (*.json) with a section \"limits\", which is submitted and run first; or\n"
      "a campaign of one; default: the newest");
  add_workers(command, a.n_workers, "of the run; default: the cores available");
  command->add_option("--top", a.top, "how many rows (default 20); 0 = all")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--map", a.map, "A B: the limit as a table, parameter A across and B down")
      ->expected(2);
  add_store(command, program.common);
  add_renderings(command, program.common);
  command->footer(
      "Examples:\n"
      "  faultsweep limits storage-limit.json             search, then the narrowest bands first\n"
      "  faultsweep limits storage-limit --map offset friction_angle\n"
      "  faultsweep limits storage-limit --csv >limits.csv\n"
      "Each limit is a pair of computed cases, one on either side of it.");
}

}  // namespace faultsweep
