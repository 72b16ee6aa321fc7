#include "simulator/app/load_scene.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "simulator/app/screen.h"
#include "simulator/common/interrupt.h"
#include "simulator/common/machine.h"
#include "simulator/loading/pressure_warnings.h"
#include "simulator/simulation/inside.h"

namespace faultsim {
namespace {

std::filesystem::path user_cache() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"))
    return std::filesystem::path(xdg) / "faultsim";
  if (const char* home = std::getenv("HOME"))
    return std::filesystem::path(home) / ".cache" / "faultsim";
  return {};
}

}  // namespace

Changes changes_of(const SceneArguments& arguments) {
  Changes changes;
  if (!arguments.tier.empty()) changes.push_back({"/tier", arguments.tier});
  for (const std::string& change : arguments.set) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos) {
      throw InputError("--set", "\"" + change + "\" has no \"=\"",
                       "write --set /json/pointer=value or --set alias=value");
    }
    changes.push_back({change.substr(0, equals), change.substr(equals + 1)});
  }
  return changes;
}

Simulation load_simulation(const SceneArguments& scene, const OperatorArguments& op, bool exact) {
  Simulation simulation = Simulation::from_file(scene.file, changes_of(scene), exact);
  simulation.keep_operators(cache_policy(op));
  return simulation;
}

LoadedScene load_scene(const SceneArguments& arguments) {
  LoadedScene loaded = load_scene(read_scene_file(arguments.file, changes_of(arguments)));
  loaded.plan.warnings = pressure_warnings(loaded.scene);
  return loaded;
}

nlohmann::json remarks_to_json(const LoadedScene& loaded) {
  nlohmann::json remarks = nlohmann::json::array();
  for (const Remark& remark : loaded.scene.remarks) {
    remarks.push_back({{"pointer", remark.pointer},
                       {"line", loaded.document.line_of(remark.pointer)},
                       {"what", remark.what}});
  }
  for (const std::string& warning : loaded.plan.warnings)
    remarks.push_back({{"pointer", ""}, {"line", 0}, {"what", warning}});
  return remarks;
}

std::string remarks_to_text(const LoadedScene& loaded) {
  std::string text;
  for (const Remark& remark : loaded.scene.remarks) {
    const int line = loaded.document.line_of(remark.pointer);
    text += "warning: " + loaded.document.source + (line > 0 ? concat(":", line) : std::string()) +
            ": " + remark_text(remark) + "\n";
  }
  return text;
}

CachePolicy cache_policy(const OperatorArguments& arguments) {
  CachePolicy policy;
  if (!arguments.no_cache) {
    policy.folder = arguments.cache.empty() ? user_cache() : arguments.cache;
  }
  return policy;
}

RunContext context_of(const OperatorArguments& arguments, Monitor& monitor) {
  return {monitor, stop_on_signals(), arguments.threads > 0 ? arguments.threads : usable_cores()};
}

const PreparedOperator& prepare_on_screen(Simulation& simulation,
                                          const OperatorArguments& arguments, bool quiet) {
  ScreenMonitor monitor(quiet);
  simulation.prepare(context_of(arguments, monitor));
  monitor.clear();
  return Inside::prepared(simulation);
}

}  // namespace faultsim
