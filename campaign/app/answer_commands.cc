#include <cstdio>
#include <nlohmann/json.hpp>

#include "campaign/app/commands.h"
#include "simulator/output/json_text.h"

namespace faultsweep {
namespace {

void print(const std::string& text) { std::fputs(text.c_str(), stdout); }

}  // namespace

ExitCode probability_command(const StoreArguments& common, const ProbabilityRequest& request) {
  const Store store = Store::open_reader(common.store);
  const Probability found =
      find_probability(store, store.campaign(common.campaign, false), request);
  print(common.json ? faultsim::json_text(probability_to_json(found)) : probability_to_text(found));
  return ExitCode::done;
}

ExitCode sensitivity_command(const StoreArguments& common, const SensitivityRequest& request) {
  const Store store = Store::open_reader(common.store);
  const Sensitivity found =
      analyse_sensitivity(store, store.campaign(common.campaign, false), request);
  print(common.json ? faultsim::json_text(sensitivity_to_json(found)) : sensitivity_to_text(found));
  return ExitCode::done;
}

}  // namespace faultsweep
