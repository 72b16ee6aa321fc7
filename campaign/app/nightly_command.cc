#include <cstdio>
#include <nlohmann/json.hpp>

#include "campaign/app/commands.h"
#include "campaign/app/print_answer.h"
#include "campaign/nightly/night_report.h"
#include "simulator/files/json_text.h"

namespace faultsweep {

using faultsim::InputError;

ExitCode nightly_command(const NightRequest& request, bool json) {
  if (request.bless && request.reason.find_first_not_of(" \t\n") == std::string::npos) {
    throw InputError("--reason",
                     {{"", 0, "the reason is empty", "say why these results are right"}});
  }
  const std::optional<NightOutcome> night =
      run_night(request, {simulator_binary(), FAULTSIM_VERSION});
  if (!night) return ExitCode::regress;
  const std::string text =
      json ? faultsim::json_text(night_to_json(night->record, night->remarks, night->advice))
           : night_to_text(night->record, night->remarks, night->advice, screen_width());
  std::fputs(text.c_str(), stdout);
  return static_cast<ExitCode>(night->record.exit_code);
}

ExitCode nightly_history_command(const std::filesystem::path& store, bool json) {
  const std::vector<NightRecord> nights = Store::open_reader(store).nights("", kNightsShown);
  const std::string text =
      json ? faultsim::json_text(history_to_json(nights)) : history_to_text(nights, screen_width());
  std::fputs(text.c_str(), stdout);
  return ExitCode::done;
}

}  // namespace faultsweep
