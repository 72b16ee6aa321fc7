#pragma once

#include "simulator/app/commands.h"
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
/// The same for a document at hand (a campaign's case).
LoadedScene load_scene(JsonDocument document);

}  // namespace faultsim
