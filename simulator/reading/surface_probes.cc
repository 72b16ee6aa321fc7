#include "simulator/reading/surface_probes.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "simulator/common/fingerprint.h"
#include "simulator/common/text.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;

constexpr const char* kSurface = "/numerics/surface";

/// What says nothing of how a case runs.
constexpr const char* kSilentMembers[] = {"title", "output", "comment"};

}  // namespace

std::vector<std::vector<PlacedValue>> surface_probes(const JsonDocument& document) {
  std::vector<std::vector<PlacedValue>> cases;
  const json* list = value_at(document.value, concat(kSurface, "/probes/cases"));
  if (list == nullptr || !list->is_array()) return cases;
  const auto aliases = parameter_aliases(document);
  for (const json& one : *list) {
    std::vector<PlacedValue>& values = cases.emplace_back();
    if (!one.is_object()) continue;
    for (const auto& [name, value] : one.items()) {
      const auto alias = aliases.find(name);
      values.push_back({alias == aliases.end() ? name : alias->second, value});
    }
  }
  return cases;
}

std::string fingerprint_of_probes(const JsonDocument& document,
                                  const std::set<std::string>& replaced) {
  json rest = json::object(), cases;
  for (const auto& [name, member] : document.value.items()) {
    if (std::ranges::find(kSilentMembers, name) != std::end(kSilentMembers)) continue;
    rest[name] = member;
  }
  const json::iterator numerics = rest.find("numerics");
  cases.swap(numerics->at("surface").at("probes").at("cases"));
  numerics->erase("surface");
  for (const std::string& pointer : replaced) {
    if (value_at(rest, pointer) != nullptr) put_value(rest, pointer, nullptr);
  }
  return fingerprint(cases.dump() + rest.dump());
}

Scene probing_scene(const JsonDocument& document, std::size_t i, const Scene& at,
                    const std::vector<SurfaceParameter>& over) {
  JsonDocument changed = document;
  changed.source = concat(document.source, ", probing case ", i);
  std::vector<Problem> problems;
  const std::vector<PlacedValue> values = surface_probes(document).at(i);
  for (const auto& [pointer, value] : values) {
    if (put_value(changed.value, pointer, value)) continue;
    problems.push_back({pointer, 0, "the scene has no place for it", "name another parameter"});
  }
  changed.value["numerics"].erase("surface");
  Scene scene = read_scene(changed, problems);
  if (!problems.empty()) throw InputError(changed.source, std::move(problems));
  for (const SurfaceParameter& one : over) set_value(one, value_of(one, at), scene);
  for (std::size_t b = 0; b < scene.field.blocks.size(); ++b)
    scene.field.blocks[b].mesh_offset = at.field.blocks[b].mesh_offset;
  return scene;
}

}  // namespace faultsim
