#include <cstdio>
#include <filesystem>
#include <tuple>

#include "campaign/answers/limit_table.h"
#include "campaign/app/commands.h"
#include "campaign/app/print_answer.h"
#include "campaign/expansion/submission.h"
#include "campaign/rounds/next_round.h"
#include "campaign/scheduler/starter.h"

namespace faultsweep {

using faultsim::InputError;

namespace {

/// Submits a spec and searches its limits; the name of its campaign, and how the search ended.
std::pair<std::string, ExitCode> search_limits(const StoreArguments& common,
                                               const LimitsArguments& arguments) {
  const Expansion expansion = expand(read_campaign(arguments.source));
  if (expansion.spec.limits.empty()) {
    throw InputError(arguments.source, {{"/limits", 0, "the spec searches no limits",
                                         "add a section \"limits\", or use faultsweep submit"}});
  }
  check_rounds(expansion);
  const SubmitOutcome submitted =
      Store::open_writer(common.store).submit(make_submission(expansion));
  RunOptions options;
  options.store = common.store;
  options.campaign = submitted.name;
  options.n_workers = arguments.n_workers;
  options.simulator = simulator_binary();
  return {submitted.name, start_ranks(options)};
}

}  // namespace

ExitCode limits_command(const StoreArguments& common, const LimitsArguments& arguments) {
  std::string name = arguments.source;
  ExitCode status = ExitCode::done;
  if (std::filesystem::path(name).extension() == ".json") {
    std::tie(name, status) = search_limits(common, arguments);
    if (status != ExitCode::done && status != ExitCode::incomplete) return status;
  }
  const Store store = Store::open_reader(common.store);
  const LimitTable table = make_limit_table(store, store.campaign(name));
  print_answer(arguments.map.empty() ? to_answer(table, arguments.top)
                                     : map_answer(table, arguments.map.at(0), arguments.map.at(1)),
               common);
  if (!table.is_finished) {
    std::fprintf(stderr, "Next: faultsweep run %s --store %s\n", table.campaign.name.c_str(),
                 common.store.c_str());
  }
  return status;
}

}  // namespace faultsweep
