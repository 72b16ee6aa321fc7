#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "simulator/common/near_miss.h"
#include "simulator/common/ranges.h"
#include "simulator/reading/fault_places.h"
#include "simulator/reading/read_scene.h"
#include "simulator/reading/scene_reader.h"

/// Parameters are found by walking the schema along the document: what is there, and what could be.
namespace faultsim {
namespace {

using nlohmann::json;

std::string text_at(const json& document, const std::string& pointer) {
  const json* value = value_at(document, pointer);
  if (value == nullptr) return "";
  return value->is_string() ? value->get<std::string>() : value->dump();
}

std::size_t size_at(const json& document, const std::string& pointer) {
  const json* value = value_at(document, pointer);
  return value != nullptr && value->is_array() ? value->size() : 0;
}

/// What the pressure regions of a body are listed as.
const char* list_of_regions(const json& document) {
  const std::string kind = text_at(document, "/geometry/kind");
  if (kind == "horizons") return "/geometry/compartments";
  return kind == "field" ? "/geometry/blocks" : "/geometry/regions";
}

/// Letters, digits and '_' only, so that an alias can stand in an expression.
std::string as_word(const std::string& name) {
  std::string word;
  for (const char letter : name) {
    const bool fine = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
    word += fine ? letter : '_';
  }
  return word;
}

/// Short names of pointers in one document; the first name of a pointer is the one to show.
class Aliases {
 public:
  explicit Aliases(const json& document) : document_(document) {
    add_fixed();
    add_blocks();
    add_materials();
    add_faults();
    add_stages();
  }
  std::string of(const std::string& pointer) const {
    const auto found = first_.find(pointer);
    return found == first_.end() ? "" : found->second;
  }
  const std::map<std::string, std::string>& pointers() const { return pointers_; }

 private:
  void add(const std::string& alias, const std::string& pointer) {
    if (!pointers_.emplace(alias, pointer).second) return;  // names of users come last
    first_.emplace(pointer, alias);
  }
  void add_fixed() {
    if (!is_mesh() && !is_built()) add("tier", "/tier");
    for (const char* key : {"ratio_across", "ratio_along", "initial_biot", "overpressure"}) {
      add(key, std::string("/initial_state/") + key);
    }
    const std::string rule = text_at(document_, "/fault_pressure/rule");
    add("fault_pressure",
        std::string("/fault_pressure/") + (rule == "prescribed" ? "prescribed" : "rule"));
    add("fault_pressure_rule", "/fault_pressure/rule");
    add("fault_pressure_change", "/fault_pressure/prescribed");
    add("fault_pressure_fraction", "/fault_pressure/fraction");
    add("fault_biot", "/fault_pressure/fault_biot");
    for (const char* key :
         {"friction_angle", "friction_coefficient", "dynamic_friction_angle",
          "dynamic_friction_coefficient", "slip_weakening_distance", "cohesion"}) {
      add(key, std::string("/friction/") + key);
    }
    add("slip_tolerance", "/numerics/slip_tolerance");
    add("activation_length", "/numerics/activation_length");
    for (const char* key : {"strike", "dip", "normal"}) {
      if (is_mesh() || (is_built() && std::string_view(key) != "strike")) continue;
      add(std::string("mesh_") + key, std::string("/mesh/") + key);
    }
  }
  bool is_mesh() const { return text_at(document_, "/geometry/kind") == "mesh"; }
  bool is_built() const { return text_at(document_, "/geometry/kind") == "horizons"; }
  void add_compartment(const std::string& name) {
    const std::string compartment = "/compartments/" + pointer_token(name);
    add("scale_" + as_word(name), compartment + "/scale");
    add("lag_" + as_word(name), compartment + "/lag");
  }
  void add_volumes() {
    const nlohmann::json* volumes = value_at(document_, "/geometry/volumes");
    if (!is_mesh() || volumes == nullptr || !volumes->is_object()) return;
    for (const auto& [name, volume] : volumes->items()) {
      const std::string compartment =
          text_at(document_, "/geometry/volumes/" + pointer_token(name) + "/compartment");
      if (!compartment.empty()) add_compartment(compartment);
    }
  }
  void add_blocks() {
    const bool is_field = text_at(document_, "/geometry/kind") == "field";
    const std::string list = list_of_regions(document_);
    const std::size_t n = size_at(document_, list);
    if (is_field && n > 0) add("offset", element(list, n - 1) + "/offset");
    for (std::size_t i = 0; i < n; ++i) {
      const std::string name = text_at(document_, element(list, i) + "/name");
      if (is_field) add("offset_" + as_word(name), element(list, i) + "/offset");
      if (is_field) add("overpressure_" + as_word(name), element(list, i) + "/overpressure");
      add_compartment(name);
    }
    add_volumes();
  }
  void add_material(const std::string& word, const std::string& material) {
    if (material.empty()) return;
    const std::string at = "/materials/" + pointer_token(material) + "/";
    add(word + "_stiffness", at + "youngs_modulus");
    add(word + "_poisson", at + "poisson_ratio");
    add(word + "_density", at + "density");
    add(word + "_biot", at + "biot");
    add(word + "_viscosity", at + "viscosity");
  }
  void add_materials() {
    const std::string layers = "/geometry/layers";
    const std::string reservoir = text_at(document_, "/geometry/reservoir_layer");
    for (std::size_t i = 0; i < size_at(document_, layers); ++i) {
      if (text_at(document_, element(layers, i) + "/name") != reservoir) continue;
      const std::string material = text_at(document_, element(layers, i) + "/material");
      add("biot", "/materials/" + pointer_token(material) + "/biot");
      add_material("reservoir", material);
      if (i > 0) {
        add_material("caprock", text_at(document_, element(layers, i - 1) + "/material"));
      }
    }
    add_material("sideburden", text_at(document_, "/geometry/sideburden"));
    if (!document_.contains("materials") || !document_["materials"].is_object()) return;
    for (const auto& [name, material] : document_["materials"].items()) {
      add_material(as_word(name), name);
    }
  }
  void add_faults() {
    const std::size_t n = size_at(document_, "/faults");
    if (n > 0 && !is_mesh()) add("central_dip", element("/faults", n / 2) + "/dip_from_vertical");
    for (std::size_t i = 0; i < n; ++i) {
      const std::string at = element("/faults", i) + "/";
      const std::string name = as_word(text_at(document_, at + "name"));
      if (!is_mesh()) add("dip_" + name, at + "dip_from_vertical");
      if (is_built()) add("throw_" + name, at + "throw");
      for (const char* key :
           {"friction_angle", "dynamic_friction_angle", "slip_weakening_distance", "cohesion"}) {
        add(std::string(key) + "_" + name, at + "friction/" + key);
      }
      add("fault_pressure_rule_" + name, at + "fault_pressure/rule");
      add("fault_pressure_change_" + name, at + "fault_pressure/prescribed");
    }
  }
  void add_stages() {
    for (std::size_t i = 0; i < size_at(document_, "/stages"); ++i) {
      const std::string at = element("/stages", i) + "/";
      const std::string name = as_word(text_at(document_, at + "name"));
      add(name + "_pressure", at + "pressure_change");
      add(name + "_absolute_pressure", at + "pressure");
      add(name + "_first_pressure", at + "pressure_between/0");
      add(name + "_second_pressure", at + "pressure_between/1");
      add(name + "_duration", at + "duration");
      add(name + "_steps", at + "steps");
    }
  }

  const json& document_;
  std::map<std::string, std::string> pointers_;
  std::map<std::string, std::string> first_;
};

std::string range_text(const SchemaViews& views) {
  if (keyword(views, "enum") != nullptr) {
    std::string text;
    for (const std::string& word : enum_texts(views)) text += (text.empty() ? "{" : ", ") + word;
    return text + "}";
  }
  const std::string above = keyword_text(views, "x-above");
  std::string least = keyword_text(views, "x-minimum");
  std::string most = keyword_text(views, "x-maximum");
  if (least.empty()) least = keyword_text(views, "minimum");
  if (most.empty()) most = keyword_text(views, "maximum");
  if (above.empty() && least.empty() && most.empty()) return "";
  return (above.empty() ? (least.empty() ? "(" : "[" + least) : "(" + above) + ", " +
         (most.empty() ? ")" : most + "]");
}

/// Keys that exclude each other: where one is given the others are not parameters.
bool has_rival(const json& object, const std::string& key) {
  static const std::vector<std::vector<std::string>> groups = {
      {"friction_angle", "friction_coefficient"},
      {"dynamic_friction_angle", "dynamic_friction_coefficient"},
      {"pressure_change", "pressure", "pressure_between"},
      {"tensor", "ratio_across"},
      {"tensor", "ratio_along"},
      {"tensor", "initial_biot"},
      {"tensor", "vertical_stress"},
      {"tensor", "vertical_stress_gradient"},
      {"tensor", "viscous_layers"},
      {"surface", "listric", "dip_from_vertical"},
      {"length", "y_from"},
      {"length", "y_to"},
      {"creep_time_step", "creep_refinements"}};
  if (object.contains(key)) return false;
  return std::ranges::any_of(groups, [&](const auto& group) {
    if (!contains(group, key)) return false;
    return std::ranges::any_of(group, [&](const auto& rival) { return object.contains(rival); });
  });
}

class Collector {
 public:
  Collector(const JsonDocument& document, const Aliases& aliases)
      : document_(document), aliases_(aliases), may_creep_(has_viscosity(document.value)) {}

  void walk(const json* value, const SchemaViews& views, const std::string& pointer, bool family) {
    const json& here = value == nullptr ? null() : *value;
    if (const json* says = keyword(views, "x-new-family")) family = says->get<bool>();
    if (is_leaf(views)) {
      add_row(value, views, pointer, family);
      return;
    }
    if (here.is_array()) {
      // A list where the schema wants an object has elements only; the schema check refuses it.
      for (std::size_t i = 0; i < here.size(); ++i) {
        SchemaViews scratch;
        walk(&here[i], item_views(views, here[i], scratch), element(pointer, i), family);
      }
      return;
    }
    std::vector<std::string> keys = known_keys(views);
    if (here.is_object()) {
      for (const auto& [key, inner] : here.items()) {
        if (!std::ranges::count(keys, key) && key != "comment") keys.push_back(key);
      }
    }
    for (const std::string& key : keys) {
      if (here.is_object() && has_rival(here, key)) continue;
      const bool given = here.is_object() && here.contains(key);
      walk_child(given ? &here[key] : nullptr, views, pointer, key, family);
    }
  }

  std::vector<ParameterInfo> rows() && {
    std::ranges::stable_sort(rows_, [this](const auto& a, const auto& b) {
      return document_.line_of(a.pointer) < document_.line_of(b.pointer);
    });
    return std::move(rows_);
  }

 private:
  void walk_child(const json* value, const SchemaViews& parent, const std::string& at,
                  const std::string& key, bool family) {
    const std::string pointer = at + "/" + pointer_token(key);
    if (is_hidden(pointer)) return;
    const json& here = value == nullptr ? null() : *value;
    SchemaViews scratch;
    walk(value, member_views(parent, key, here, scratch), pointer, family);
  }
  /// Whether a material of the document has a viscosity and creep is not switched off.
  static bool has_viscosity(const json& document) {
    if (text_at(document, "/numerics/creep") == "off") return false;
    if (!document.is_object() || !document.contains("materials")) return false;
    const json& materials = document["materials"];
    return std::ranges::any_of(materials, [](const json& material) {
      return material.is_object() && material.contains("viscosity");
    });
  }
  /// Creep takes the steps of the stages, and each length of a step has an operator.
  bool makes_creep_steps(const std::string& pointer) const {
    if (!may_creep_) return false;
    const std::string key = pointer.substr(pointer.rfind('/') + 1);
    // Histories turn where they lag to, and steps end there.
    if (key == "lag" || key == "turning_points") return true;
    if (pointer.rfind("/stages/", 0) != 0) return false;
    return key == "duration" || key == "steps";
  }
  static const json& null() {
    static const json nothing;
    return nothing;
  }
  bool is_hidden(const std::string& pointer) const {
    const std::string kind = text_at(document_.value, "/geometry/kind");
    const bool field = kind == "field";
    constexpr std::string_view kFaults = "/faults/";
    const std::size_t slash = pointer.rfind('/');
    if (pointer.starts_with(kFaults) && pointer.find('/', kFaults.size()) == slash) {
      const std::string_view key = std::string_view(pointer).substr(slash + 1);
      if (contains(all_place_keys(), key) && !contains(place_keys(kind), key)) return true;
    }
    const bool absent = (pointer == "/pressure_field" || pointer == "/temperature_field") &&
                        child_at(document_.value, pointer.substr(1)) == nullptr;
    return pointer == "/format" || pointer == "/title" || pointer == "/output" ||
           pointer == "/numerics/surface" || pointer == "/tables" || pointer == "/fields" ||
           absent || (!field && pointer == "/tier");
  }
  static bool is_leaf(const SchemaViews& views) {
    if (keyword(views, "x-dimension") != nullptr || keyword(views, "enum") != nullptr) return true;
    const std::string type = keyword_text(views, "type");
    return type == "number" || type == "integer" || type == "boolean";
  }
  void add_row(const json* value, const SchemaViews& views, const std::string& pointer,
               bool family) {
    if (keyword(views, "x-hidden") != nullptr) return;
    const std::string dimension = keyword_text(views, "x-dimension");
    ParameterInfo row;
    row.pointer = pointer;
    row.alias = aliases_.of(pointer);
    row.dimension = dimension.empty() ? Dimension::number : dimension_named(dimension)->dimension;
    row.default_value = keyword_text(views, "default");
    // A fault's own friction and fault_pressure default to those at the top level.
    for (const char* object : {"/friction/", "/fault_pressure/"}) {
      const auto at = pointer.find(object);
      if (at == 0 || at == std::string::npos) continue;
      const std::string shared = text_at(document_.value, pointer.substr(at));
      if (!shared.empty()) row.default_value = shared;
    }
    row.value = value == nullptr ? row.default_value : text_at(document_.value, pointer);
    row.range = keyword_text(views, "type") == "boolean" ? "{true, false}" : range_text(views);
    row.new_family = family || makes_creep_steps(pointer);
    row.description = keyword_text(views, "description");
    row.is_text = keyword(views, "enum") != nullptr || keyword_text(views, "type") == "boolean";
    rows_.push_back(row);
  }

  const JsonDocument& document_;
  const Aliases& aliases_;
  bool may_creep_;
  std::vector<ParameterInfo> rows_;
};

/// An offset of a block without mesh_offset has a surface, and so a family, for each interval.
bool is_taken_in_intervals(const json& document, const std::string& pointer) {
  const std::size_t slash = pointer.rfind('/');
  return pointer.substr(slash + 1) == "offset" &&
         text_at(document, pointer.substr(0, slash) + "/mesh_offset").empty();
}

}  // namespace

std::vector<ParameterInfo> parameters(const JsonDocument& document) {
  const Aliases aliases(document.value);
  Collector collector(document, aliases);
  json completed = document.value;
  // Optional objects by name do not show in the schema: a compartment per region.
  const std::string list = list_of_regions(completed);
  for (std::size_t i = 0; i < size_at(completed, list); ++i) {
    const std::string name = text_at(completed, element(list, i) + "/name");
    json& compartments = completed["compartments"];
    const bool is_object = compartments.is_null() || compartments.is_object();
    if (is_object && !compartments.contains(name)) compartments[name] = json::object();
  }
  collector.walk(&completed, schema_views(scene_schema().root(), completed), "", false);
  std::vector<ParameterInfo> rows = std::move(collector).rows();
  const json* is_exact = value_at(completed, "/numerics/surface/exact");
  if (is_exact != nullptr && *is_exact == true) return rows;
  for (std::size_t i = 0; i < size_at(completed, "/numerics/surface/over"); ++i) {
    const std::string given =
        text_at(completed, element("/numerics/surface/over", i) + "/parameter");
    const auto alias = aliases.pointers().find(given);
    const std::string& pointer = alias == aliases.pointers().end() ? given : alias->second;
    const auto row = std::ranges::find(rows, pointer, &ParameterInfo::pointer);
    if (row != rows.end() && !is_taken_in_intervals(completed, pointer)) row->new_family = false;
  }
  return rows;
}

std::map<std::string, std::string> parameter_aliases(const JsonDocument& document) {
  return Aliases(document.value).pointers();
}

std::string resolve_parameter(const JsonDocument& document, const std::string& alias_or_pointer) {
  if (!alias_or_pointer.empty() && alias_or_pointer[0] == '/') return alias_or_pointer;
  const auto aliases = parameter_aliases(document);
  const auto found = aliases.find(alias_or_pointer);
  if (found != aliases.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [alias, pointer] : aliases) names.push_back(alias);
  throw InputError(document.source, "there is no parameter \"" + alias_or_pointer + "\"",
                   suggest(alias_or_pointer, names));
}

}  // namespace faultsim
