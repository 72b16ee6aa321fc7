#include "simulator/reading/csv_tables.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "simulator/common/input_file.h"
#include "simulator/common/printable.h"
#include "simulator/common/ranges.h"
#include "simulator/common/table_reader.h"
#include "simulator/flow/field_file.h"
#include "simulator/gmsh/gmsh_mesh.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// Relative paths count from the folder of the scene file.
std::string path_of(const std::string& source, const std::string& name) {
  const auto slash = source.rfind('/', source.find('#'));
  const bool relative = name[0] != '/' && slash != std::string::npos;
  return relative ? source.substr(0, slash + 1) + name : name;
}

std::string file_text(const std::string& path, const std::string& name) {
  constexpr std::size_t kMostBytes = 16'000'000;  // 10^5 rows of ten columns
  InputText file = read_input_file(path, kMostBytes);
  const bool relative = !name.empty() && name[0] != '/';
  if (!file.what.empty() && relative) file.cure += "; it is looked for in the scene's folder";
  if (!file.what.empty()) throw InputError(path, file.what, file.cure);
  return std::move(file.text);
}

/// Lines that say the same where texts must be printable: tabs between cells become semicolons,
/// other tabs blanks, and what a comment holds is spelled out. None where a table is to be refused.
std::optional<json> lines_of(std::string_view text) {
  json lines = json::array();
  std::optional<char> separator;
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  while (!text.empty()) {
    std::string line(next_table_line(text));
    const bool idle = is_idle_table_line(line);
    if (!idle && !separator) separator = table_separator(line);
    std::ranges::replace(line, '\t', separator == '\t' && !idle ? ';' : ' ');
    if (idle) line = printable(line);
    if (!first_unprintable(line).empty()) return std::nullopt;
    lines.push_back(line);
  }
  return lines;
}

const json* table_in(const json& scene, const std::string& name) {
  if (!scene.is_object() || !scene.contains("tables")) return nullptr;
  const json& tables = scene["tables"];
  if (!tables.is_object() || !tables.contains(name) || !tables[name].is_array()) return nullptr;
  return &tables[name];
}

void embed_field(json& scene, const std::string& source, const std::string& name,
                 FlowQuantity quantity) {
  const FieldPlace place = field_place(scene, source, name);
  if (!place.fingerprint.empty()) return;
  if (scene.contains("fields") && !scene["fields"].is_object()) return;  // the schema refuses it
  try {
    const std::string path = std::filesystem::absolute(place.path).lexically_normal().string();
    const FieldFile file = read_field_file(place.path, quantity);
    if (first_unprintable(path).empty())
      scene["fields"][name] = {{"path", path}, {"fingerprint", file.fingerprint}};
  } catch (const InputError&) {  // said by who reads the scene, as is an odd path
  }
}

/// The same of a mesh.
void embed_mesh(json& scene, const std::string& source, const std::string& name) {
  const FieldPlace place = field_place(scene, source, name);
  if (!place.fingerprint.empty()) return;
  if (scene.contains("fields") && !scene["fields"].is_object()) return;
  try {
    const std::string path = std::filesystem::absolute(place.path).lexically_normal().string();
    if (first_unprintable(path).empty())
      scene["fields"][name] = {{"path", path}, {"fingerprint", read_gmsh(place.path).fingerprint}};
  } catch (const InputError&) {  // said by who reads the scene
  }
}

}  // namespace

std::vector<std::string> table_names(const json& scene) {
  std::vector<std::string> names;
  const auto add = [&](const json& object, const char* key) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return;
    const auto name = object[key].get<std::string>();
    const bool known = contains(names, name);
    if (!name.empty() && !known) names.push_back(name);
  };
  if (!scene.is_object()) return names;
  add(scene, "pressure_csv");
  const auto add_fault_pressure = [&](const json& object) {
    if (object.is_object() && object.contains("fault_pressure"))
      add(object["fault_pressure"], "csv");
  };
  add_fault_pressure(scene);
  if (const json* faults = child_at(scene, "faults"); faults != nullptr && faults->is_array()) {
    for (const json& fault : *faults) {
      add_fault_pressure(fault);
      add(fault, "surface");
    }
  }
  if (const json* layers = value_at(scene, "/geometry/layers");
      layers != nullptr && layers->is_array()) {
    for (const json& layer : *layers)
      if (layer.is_object() && layer.contains("top")) add(layer["top"], "csv");
  }
  if (!scene.contains("compartments") || !scene["compartments"].is_object()) return names;
  for (const json& compartment : scene["compartments"]) add(compartment, "csv");
  return names;
}

void embed_table(json& scene, const std::string& source, const std::string& name) {
  if (!scene.is_object() || table_in(scene, name) != nullptr) return;
  if (scene.contains("tables") && !scene["tables"].is_object()) return;  // the schema refuses it
  try {
    if (auto lines = lines_of(table_text(scene, source, name)))
      scene["tables"][name] = *std::move(lines);
  } catch (const InputError&) {  // said by who reads the scene
  }
}

void embed_tables(JsonDocument& document) {
  for (const std::string& name : table_names(document.value)) {
    embed_table(document.value, document.source, name);
  }
  embed_fields(document.value, document.source, json(document.value));
}

FieldPlace field_place(const json& scene, const std::string& source, const std::string& name) {
  const std::string at = "/fields/" + pointer_token(name);
  const json* path = value_at(scene, at + "/path");
  const json* fingerprint = value_at(scene, at + "/fingerprint");
  const bool is_known =
      path != nullptr && path->is_string() && fingerprint != nullptr && fingerprint->is_string();
  if (!is_known) return {path_of(source, name), ""};
  return {path->get<std::string>(), fingerprint->get<std::string>()};
}

void embed_fields(json& scene, const std::string& source, const json& named) {
  for (const auto& [pointer, quantity] :
       {std::pair{"/pressure_field/file", FlowQuantity::pressure},
        std::pair{"/temperature_field/file", FlowQuantity::temperature}}) {
    const json* name = value_at(named, pointer);
    if (scene.is_object() && name != nullptr && name->is_string())
      embed_field(scene, source, name->get<std::string>(), quantity);
  }
  const json* mesh = value_at(named, "/geometry/file");
  if (scene.is_object() && mesh != nullptr && mesh->is_string())
    embed_mesh(scene, source, mesh->get<std::string>());
}

std::string table_text(const json& scene, const std::string& source, const std::string& name) {
  const json* lines = table_in(scene, name);
  if (lines == nullptr) return file_text(path_of(source, name), name);
  std::string text;
  for (const json& line : *lines) {
    if (line.is_string()) text += line.get<std::string>();
    text += '\n';
  }
  return text;
}

}  // namespace faultsim
