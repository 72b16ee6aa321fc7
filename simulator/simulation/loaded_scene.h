#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulator/plan/field_check.h"
#include "simulator/plan/plan.h"
#include "simulator/reading/changed_scene.h"
#include "simulator/simulation/simulation.h"

namespace faultsim {

/// A scene that was read and found sound, and what will be modelled of it.
struct LoadedScene : ChangedScene {
  Plan plan;
  std::string identity;                        ///< of the case.
  std::shared_ptr<const Mesh> mesh = nullptr;  ///< where check_geometry() has made it.
};

/// The file with the changes put in, and the text of the tables that it names: what is read now is
/// what runs. Throws InputError with all that is wrong with the changes.
JsonDocument read_scene_file(const std::string& file, const Changes& changes);
/// Puts changes into a document, in order. Throws InputError with all that is wrong with them.
void apply(const Changes& changes, JsonDocument& document);

/// Checks everything and plans, without the plan's warnings. Throws InputError with all problems of
/// scene and geometry.
LoadedScene load_scene(JsonDocument document);
/// A scene that was loaded with other values put into its base, of which only what they touch is
/// read and planned again. Throws InputError like load_scene().
/// @returns nothing where a value has no place in base.
std::optional<LoadedScene> reload_scene(const JsonDocument& base, std::vector<PlacedValue> values,
                                        const std::string& source, const LoadedScene& other);
/// What a run would refuse once it has the mesh (plan/geometry_check.h) or maps its flow results
/// (plan/field_check.h), thrown as InputError with its place in the file. Makes the mesh, unless
/// that is large. @returns what else is to be said of the flow results.
FieldCheck check_geometry(LoadedScene& loaded);
/// The files that the scene was read from: its own and those that it names.
std::vector<std::filesystem::path> input_files(const LoadedScene& loaded);

/// Two scenes with the same key run on the same operator, names and all.
std::string operator_key(const LoadedScene& loaded);

}  // namespace faultsim
