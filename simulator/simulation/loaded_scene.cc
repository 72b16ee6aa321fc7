#include "simulator/simulation/loaded_scene.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "simulator/files/output_target.h"
#include "simulator/plan/geometry_check.h"
#include "simulator/reading/csv_tables.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

/// Throws them, if there are any, with the lines of what they are about.
void throw_problems(const JsonDocument& document, std::vector<Problem> problems) {
  if (problems.empty()) return;
  for (Problem& problem : problems) {
    if (problem.line == 0) problem.line = document.line_of(problem.pointer);
  }
  throw InputError(document.source, std::move(problems));
}

}  // namespace

void apply(const Changes& changes, JsonDocument& document) {
  std::vector<Problem> problems;
  for (const Change& change : changes) {
    try {
      set_value(document, resolve_parameter(document, change.parameter), change.value);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_problems(document, std::move(problems));
}

JsonDocument read_scene_file(const std::string& file, const Changes& changes) {
  JsonDocument document = read_json_file(file);
  apply(changes, document);
  embed_tables(document);
  return document;
}

LoadedScene load_scene(JsonDocument document) {
  LoadedScene loaded;
  loaded.document = std::move(document);
  std::vector<Problem> problems;
  loaded.scene = read_scene(loaded.document, problems);
  if (problems.empty()) loaded.plan = make_plan(loaded.scene, problems);
  throw_problems(loaded.document, std::move(problems));
  loaded.canonical = canonical_parts(loaded.scene);
  loaded.is_of_base = true;  // with no values
  loaded.identity = case_identity(loaded.canonical);
  return loaded;
}

std::optional<LoadedScene> reload_scene(const JsonDocument& base, std::vector<PlacedValue> values,
                                        const std::string& source, const LoadedScene& other) {
  LoadedScene loaded = other;
  loaded.document.source = source;
  loaded.document.lines.clear();
  loaded.mesh.reset();
  std::vector<Problem> problems;
  if (!change_scene(base, std::move(values), Relations::checked, loaded, problems).empty())
    return std::nullopt;
  if (problems.empty()) loaded.plan = make_plan(loaded.scene, problems, other.scene, other.plan);
  throw_problems(loaded.document, std::move(problems));
  loaded.identity = case_identity(loaded.canonical);
  return loaded;
}

FieldCheck check_geometry(LoadedScene& loaded) {
  std::vector<Problem> problems = geometry_problems(loaded.scene, loaded.plan, &loaded.mesh);
  FieldCheck fields;
  if (problems.empty()) fields = check_fields(loaded.scene, loaded.plan);
  problems.insert(problems.end(), fields.problems.begin(), fields.problems.end());
  throw_problems(loaded.document, std::move(problems));
  return fields;
}

std::vector<std::filesystem::path> input_files(const LoadedScene& loaded) {
  return files_named_in(loaded.document.value, loaded.document.source);
}

std::string operator_key(const LoadedScene& loaded) {
  std::string key = loaded.plan.family;
  for (const Fault& fault : loaded.scene.faults) key += "/" + fault.name;
  for (const ObservationPoint& point : loaded.scene.output.observation_points) {
    key +=
        concat("/", point.name, point.position[0], ",", point.position[1], ",", point.position[2]);
  }
  return key;
}

}  // namespace faultsim
