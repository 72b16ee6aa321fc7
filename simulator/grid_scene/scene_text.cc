#include "simulator/grid_scene/grid_scene.h"

namespace faultsim::grid_scene {
namespace {

constexpr std::size_t kWidth = 100;

/// On one line, with blanks within braces and after commas.
std::string on_one_line(const nlohmann::ordered_json& value) {
  if (!value.is_structured() || value.empty()) return value.dump();
  std::string text;
  for (const auto& [key, one] : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += nlohmann::json(key).dump() + ": ";
    text += on_one_line(one);
  }
  return value.is_object() ? "{ " + text + " }" : "[" + text + "]";
}

std::string indented(const nlohmann::ordered_json& value, std::size_t depth, std::size_t before) {
  const std::string line = on_one_line(value);
  if (!value.is_structured() || (depth > 0 && before + line.size() < kWidth)) return line;
  const std::string indent(2 * depth + 2, ' ');
  std::string text;
  for (const auto& [key, one] : value.items()) {
    const std::string head = value.is_object() ? nlohmann::json(key).dump() + ": " : "";
    text += (text.empty() ? "\n" : ",\n") + indent + head +
            indented(one, depth + 1, indent.size() + head.size());
  }
  text += "\n" + std::string(2 * depth, ' ');
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

}  // namespace

std::string scene_text(const nlohmann::ordered_json& scene) { return indented(scene, 0, 0) + "\n"; }

}  // namespace faultsim::grid_scene
