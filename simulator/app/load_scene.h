#pragma once

#include "simulator/app/commands.h"
#include "simulator/loading/run_case.h"
#include "simulator/reading/read_scene.h"
#include "simulator/simulation/loaded_scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {

/// --tier and --set.
Changes changes_of(const SceneArguments& arguments);
/// The scene of a command, held; its operators are kept where the command says. Throws InputError
/// with all problems of scene and geometry.
Simulation load_simulation(const SceneArguments& scene, const OperatorArguments& op,
                           bool exact = false);
/// The same without an operator: for commands that only look.
LoadedScene load_scene(const SceneArguments& arguments);

/// The scene's remarks with their lines: [{"pointer", "line", "what"}].
nlohmann::json remarks_to_json(const LoadedScene& loaded);
/// The same for the screen: "warning: FILE:12: /friction/fraction has no effect: ...", a line each.
std::string remarks_to_text(const LoadedScene& loaded);

/// Where a command keeps operators: the folder given, or the user's cache folder, or nowhere.
CachePolicy cache_policy(const OperatorArguments& arguments);
/// Told to `monitor`, stopped by signals, with the threads asked for: as many as the process may
/// use cores where nothing was.
RunContext context_of(const OperatorArguments& arguments, Monitor& monitor);
/// Simulation::prepare with its progress and remarks on the screen, unless `quiet`.
const PreparedOperator& prepare_on_screen(Simulation& simulation,
                                          const OperatorArguments& arguments, bool quiet);

}  // namespace faultsim
