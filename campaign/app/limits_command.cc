#include <cstdio>
#include <filesystem>

#include "campaign/answers/limit_table.h"
#include "campaign/app/commands.h"
#include "campaign/app/print_answer.h"
#include "campaign/expansion/submission.h"
#include "campaign/rounds/next_round.h"
#include "campaign/scheduler/starter.h"

namespace faultsweep {

using faultsim::InputError;

namespace {

/// Submits a spec and searches its limits.
SubmittedRun search_limits(const StoreArguments& common, const LimitsArguments& arguments) {
  const Expansion expansion = expand(read_campaign(arguments.source));
  if (expansion.spec.limits.empty()) {
    throw InputError(arguments.source, {{"/limits", 0, "the spec searches no limits",
                                         "add a section \"limits\", or use faultsweep submit"}});
  }
  check_rounds(expansion);
  return submit_and_run(
      make_submission(expansion),
      {.store = common.store, .n_workers = arguments.n_workers, .simulator = simulator_binary()});
}

}  // namespace

ExitCode limits_command(const StoreArguments& common, const LimitsArguments& arguments) {
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
    std::fprintf(stderr, "Next: faultsweep run %s --store %s\n", table.campaign.name.c_str(),
                 common.store.c_str());
  }
  return run.status;
}

}  // namespace faultsweep
