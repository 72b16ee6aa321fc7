#pragma once

#include "simulator/app/commands.h"
#include "simulator/loading/run_case.h"
#include "simulator/plan/plan.h"
#include "simulator/scene/read_scene.h"

namespace faultsim {

struct LoadedScene {
  JsonDocument document;
  Scene scene;
  Plan plan;
};

/// Reads the file, applies --set and --tier, checks everything and plans. Throws InputError with
/// all problems of scene and geometry.
LoadedScene load_scene(const SceneArguments& arguments);
/// The same for a document at hand (a campaign's case), without the plan's warnings.
LoadedScene load_scene(JsonDocument document);

/// The files that the scene was read from: its own and those that it names.
std::vector<std::filesystem::path> input_files(const LoadedScene& loaded);

/// The scene's remarks with their lines: [{"pointer", "line", "what"}].
nlohmann::json remarks_to_json(const LoadedScene& loaded);
/// The same for the screen: "warning: FILE:12: /friction/fraction has no effect: ...", a line each.
std::string remarks_to_text(const LoadedScene& loaded);
/// What a run would refuse once it has the mesh (plan/geometry_check.h), thrown as InputError with
/// its place in the file. Makes the mesh, unless that is large.
void check_geometry(const LoadedScene& loaded);

/// Where a command keeps operators: the folder given, or the user's cache folder, or nowhere.
CachePolicy cache_policy(const OperatorArguments& arguments);
/// Threads as asked for; as many as the process may use cores where nothing was.
BuildOptions build_options(const OperatorArguments& arguments);
/// prepare_operator with its progress and remarks on the screen, unless `quiet`. Throws when it was
/// interrupted.
PreparedOperator prepare_on_screen(const LoadedScene& loaded, const OperatorArguments& arguments,
                                   bool quiet);

}  // namespace faultsim
