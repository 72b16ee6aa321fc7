#include "simulator/scene/csv_tables.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "simulator/common/input_file.h"
#include "simulator/flow/field_file.h"

namespace faultsim {
namespace {

using nlohmann::json;

/// Relative paths count from the folder of the scene file.
std::string path_of(const std::string& source, const std::string& name) {
  const auto slash = source.rfind('/', source.find('#'));
  const bool relative = name[0] != '/' && slash != std::string::npos;
  return relative ? source.substr(0, slash + 1) + name : name;
}

TableText file_text(const std::string& path, const std::string& name) {
  constexpr std::size_t kMostBytes = 16'000'000;  // 10^5 rows of ten columns
  InputText file = read_input_file(path, kMostBytes);
  const bool relative = !name.empty() && name[0] != '/';
  if (!file.what.empty() && relative) file.cure += "; it is taken from the folder of the scene";
  return {std::move(file.text), std::move(file.what), std::move(file.cure)};
}

/// Lines as JSON can hold and a screen can show them: without line ends, tabs and stray bytes.
json lines_of(const std::string& text) {
  json lines = json::array();
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line)) {
    if (lines.empty() && line.compare(0, 3, "\xEF\xBB\xBF") == 0) line.erase(0, 3);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    for (char& letter : line) {
      const auto byte = static_cast<unsigned char>(letter);
      if (letter == '\t')
        letter = ' ';
      else if (byte < 0x20 || byte >= 0x7f)
        letter = '?';
    }
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

}  // namespace

std::vector<std::string> table_names(const json& scene) {
  std::vector<std::string> names;
  const auto add = [&](const json& object, const char* key) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return;
    const auto name = object[key].get<std::string>();
    const bool known = std::find(names.begin(), names.end(), name) != names.end();
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
    for (const json& fault : *faults) add_fault_pressure(fault);
  }
  if (!scene.contains("compartments") || !scene["compartments"].is_object()) return names;
  for (const json& compartment : scene["compartments"]) add(compartment, "csv");
  return names;
}

void embed_table(json& scene, const std::string& source, const std::string& name) {
  if (!scene.is_object() || table_in(scene, name) != nullptr) return;
  if (scene.contains("tables") && !scene["tables"].is_object()) return;  // the schema refuses it
  const TableText table = table_text(scene, source, name);
  if (table.what.empty()) scene["tables"][name] = lines_of(table.text);
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

namespace {

void embed_field(json& scene, const std::string& source, const std::string& name,
                 FlowQuantity quantity) {
  const FieldPlace place = field_place(scene, source, name);
  if (!place.fingerprint.empty()) return;
  if (scene.contains("fields") && !scene["fields"].is_object()) return;  // the schema refuses it
  try {
    const FieldFile file = read_field_file(place.path, quantity);
    scene["fields"][name] = {
        {"path", std::filesystem::absolute(place.path).lexically_normal().string()},
        {"fingerprint", file.fingerprint}};
  } catch (const InputError&) {  // said by who reads the scene
  }
}

}  // namespace

void embed_fields(json& scene, const std::string& source, const json& named) {
  for (const auto& [pointer, quantity] :
       {std::pair{"/pressure_field/file", FlowQuantity::pressure},
        std::pair{"/temperature_field/file", FlowQuantity::temperature}}) {
    const json* name = value_at(named, pointer);
    if (scene.is_object() && name != nullptr && name->is_string())
      embed_field(scene, source, name->get<std::string>(), quantity);
  }
}

TableText table_text(const json& scene, const std::string& source, const std::string& name) {
  const json* lines = table_in(scene, name);
  if (lines == nullptr) return file_text(path_of(source, name), name);
  TableText table;
  for (const json& line : *lines) {
    if (line.is_string()) table.text += line.get<std::string>();
    table.text += '\n';
  }
  return table;
}

}  // namespace faultsim
