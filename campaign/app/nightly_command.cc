#include <nlohmann/json.hpp>

#include "campaign/app/commands.h"
#include "campaign/common/names.h"
#include "campaign/nightly/night.h"
#include "campaign/nightly/night_report.h"
#include "simulator/files/json_text.h"

namespace faultsweep {

namespace {

struct NightlyArguments : NightRequest {
  bool json = false, history = false;
};

ExitCode run_tonight(const NightRequest& request, bool json) {
  if (request.bless && request.reason.find_first_not_of(" \t\n") == std::string::npos) {
    throw InputError("--reason", "the reason is empty", "say why these results are right");
  }
  const std::optional<NightOutcome> night =
      run_night(request, {simulator_binary(), FAULTSIM_VERSION});
  if (!night) return ExitCode::regress;
  print_text(json ? faultsim::json_text(night_to_json(night->record, night->remarks, night->advice))
                  : night_to_text(night->record, night->remarks, night->advice, screen_width()));
  return static_cast<ExitCode>(night->record.exit_code);
}

ExitCode print_history(const std::filesystem::path& store, bool json) {
  const std::vector<NightRecord> nights = Store::open_reader(store).nights("", kNightsShown);
  print_text(json ? faultsim::json_text(history_to_json(nights))
                  : history_to_text(nights, screen_width()));
  return ExitCode::done;
}

ExitCode nightly(const StoreArguments&, const NightlyArguments& arguments) {
  return arguments.history ? print_history(arguments.store, arguments.json)
                           : run_tonight(arguments, arguments.json);
}

}  // namespace

void add_nightly(Program& program) {
  auto [command, n] = program.add(
      "nightly", "run a suite from scratch and compare it with its baseline, bit for bit", nightly);
  program.stores.push_back(&n.store);
  command->add_option("suite", n.suite, "suite file (default nightly.json)");
  command->add_option("--baselines", n.baselines,
                      "folder of the baselines (default results/baselines)");
  command->add_option("--store", n.store, "store of the nights (default ./faultsweep-nightly)");
  add_workers(command, n.n_workers, "as for `run`");
  CLI::Option* bless = command->add_flag("--bless", n.bless, "make tonight's results the baseline");
  CLI::Option* reason = command->add_option("--reason", n.reason, "why; kept in the baseline");
  bless->needs(reason);
  reason->needs(bless);
  command->add_flag("--history", n.history, "only list the nights so far")->excludes(bless);
  command->add_flag("--json", n.json, "machine-readable output on stdout");
  add_wide(command);
  command->footer(
      "Examples:\n"
      "  faultsweep nightly nightly.json\n"
      "  faultsweep nightly --bless --reason \"finer cells at the corners\"\n"
      "Exit codes: 0 no regression, 5 a regression, or nothing was compared.");
}

}  // namespace faultsweep
