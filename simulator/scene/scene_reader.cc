#include "simulator/scene/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "simulator/scene/near_miss.h"
#include "simulator/scene/read_scene.h"
#include "simulator/scene/schema_walk.h"

namespace faultsim {
namespace {

using nlohmann::json;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Accelerations occur once (gravity): m/s2 times kg/m3 is Pa/m, which units.h knows.
ParsedQuantity parse_acceleration(const std::string& text) {
  const auto blank = text.find(' ');
  ParsedQuantity parsed{kNaN, false, "", ""};
  if (blank != std::string::npos) {
    parsed = parse_quantity(text.substr(0, blank) + " (" + text.substr(blank + 1) + ").kg/m3",
                            Dimension::pressure_gradient);
  }
  if (!parsed.ok) {
    parsed.what = "\"" + text + "\" is not an acceleration";
    parsed.cure = "write for example \"9.81 m/s2\"";
  }
  return parsed;
}

/// Checks the range that stands in the schema; "" when inside.
std::string out_of_range(const ParsedQuantity& parsed, const SchemaViews& views,
                         const std::string& dimension) {
  const auto limit = [&](const char* name) {
    const json* text = keyword(views, name);
    return text == nullptr ? kNaN : parse_schema_quantity(*text, dimension, "").value;
  };
  constexpr double kSlack = 1e-12;  // 80 deg in rad may come out one bit larger by another unit.
  const double least = limit("x-minimum");
  const double most = limit("x-maximum");
  if (parsed.value <= limit("x-above")) return "is not above " + keyword_text(views, "x-above");
  if (parsed.value < least - kSlack * std::abs(least)) {
    return "is below " + keyword_text(views, "x-minimum");
  }
  if (parsed.value > most + kSlack * std::abs(most)) {
    return "is above " + keyword_text(views, "x-maximum");
  }
  return "";
}

std::string range_cure(const SchemaViews& views) {
  const std::string above = keyword_text(views, "x-above");
  const std::string least = keyword_text(views, "x-minimum");
  const std::string most = keyword_text(views, "x-maximum");
  if (!above.empty()) {
    return "write a value above " + above + (most.empty() ? "" : ", at most " + most);
  }
  if (least.empty()) return "write a value of at most " + most;
  return "write a value of at least " + least + (most.empty() ? "" : ", at most " + most);
}

/// Of lengths, pressures, times, ... in SI as of plain numbers: whatever is smaller was meant to be
/// zero, and its square or reciprocal would leave the range of numbers.
constexpr double kSmallest = 1e-20;

bool is_vanishing(double value) { return value != 0 && std::abs(value) < kSmallest; }

}  // namespace

Dimension dimension_named(const std::string& name) {
  static const std::map<std::string, Dimension> names = {
      {"length", Dimension::length},
      {"pressure", Dimension::pressure},
      {"pressure_gradient", Dimension::pressure_gradient},
      {"density", Dimension::density},
      {"angle", Dimension::angle},
      {"time", Dimension::time},
      {"viscosity", Dimension::viscosity}};
  const auto found = names.find(name);
  FAULTSIM_DEMAND(found != names.end(), "dimension ", name);
  return found->second;
}

ParsedQuantity parse_schema_quantity(const json& value, const std::string& dimension,
                                     const std::string& usual) {
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  if (dimension == "acceleration") return parse_acceleration(text);
  ParsedQuantity parsed = parse_quantity(text, dimension_named(dimension));
  if (!usual.empty()) {
    const std::string common = usual_unit(dimension_named(dimension));
    replace_all(parsed.cure, " " + common + "\"", " " + usual + "\"");
  }
  return parsed;
}

SceneReader::SceneReader(const JsonDocument& document, std::vector<Problem>& problems)
    : document_(document), problems_(problems) {
  const std::vector<Problem> found = check_schema(document, scene_schema());
  problems_.insert(problems_.end(), found.begin(), found.end());
  for (const Problem& one : problems_) {
    unsound_.add(one.pointer);
    said_.insert(one.pointer + "\n" + one.what);
  }
  read_quantities();
}

void SceneReader::read_quantities() {
  walk_schema(scene_schema(), document_.value,
              [this](const std::string& pointer, const json& value, const SchemaViews& views) {
                if (value.is_array()) {
                  const json* most = keyword(views, "maxItems");
                  if (most != nullptr && value.size() > most->get<std::size_t>()) {
                    too_long_.insert(pointer);
                  }
                } else if (value.is_string() || value.is_number()) {
                  read_quantity(pointer, value, views);
                }
              });
}

void SceneReader::read_quantity(const std::string& pointer, const json& value,
                                const SchemaViews& views) {
  const auto refuse_vanishing = [&] {
    problem(pointer, as_text(value) + " is not zero, but too small to mean anything", "write 0");
  };
  const std::string dimension = keyword_text(views, "x-dimension");
  if (dimension.empty()) {
    if (value.is_number() && is_vanishing(value.get<double>())) refuse_vanishing();
    return;
  }
  const ParsedQuantity parsed =
      parse_schema_quantity(value, dimension, keyword_text(views, "x-unit"));
  if (!parsed.ok) {
    problem(pointer, parsed.what, parsed.cure);
    return;
  }
  const std::string outside = out_of_range(parsed, views, dimension);
  if (!outside.empty()) {
    problem(pointer, as_text(value) + " " + outside, range_cure(views));
  } else if (is_vanishing(parsed.value)) {
    refuse_vanishing();
  } else {
    quantities_[pointer] = parsed.value;
  }
}

const json* SceneReader::find(const std::string& pointer) const {
  const json::json_pointer place(pointer);
  if (!document_.value.contains(place)) return nullptr;
  return &document_.value.at(place);
}

std::size_t SceneReader::size(const std::string& pointer) const {
  const json* value = find(pointer);
  const bool usable = value != nullptr && value->is_array() && too_long_.count(pointer) == 0;
  return usable ? value->size() : 0;
}

std::vector<std::string> SceneReader::keys(const std::string& pointer) const {
  std::vector<std::string> names;
  const json* value = find(pointer);
  if (value == nullptr || !value->is_object()) return names;
  for (const auto& [key, inner] : value->items()) names.push_back(key);
  return names;
}

double SceneReader::quantity(const std::string& pointer, double fallback) const {
  if (const auto found = quantities_.find(pointer); found != quantities_.end()) {
    return found->second;
  }
  return has(pointer) ? kNaN : fallback;
}

double SceneReader::number(const std::string& pointer, double fallback) const {
  const json* value = find(pointer);
  if (value == nullptr) return fallback;
  if (!value->is_number() || !sound(pointer)) return kNaN;
  return value->get<double>() + 0.0;  // -0 becomes 0
}

int SceneReader::integer(const std::string& pointer, int fallback) const {
  const json* value = find(pointer);
  return value != nullptr && value->is_number_integer() && sound(pointer) ? value->get<int>()
                                                                          : fallback;
}

std::string SceneReader::text(const std::string& pointer, const std::string& fallback) const {
  const json* value = find(pointer);
  if (value == nullptr) return fallback;
  return value->is_string() && sound(pointer) ? value->get<std::string>() : "";
}

bool SceneReader::boolean(const std::string& pointer, bool fallback) const {
  const json* value = find(pointer);
  return value != nullptr && value->is_boolean() ? value->get<bool>() : fallback;
}

std::array<double, 3> SceneReader::point(const std::string& pointer, double fallback) const {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = has(pointer) ? quantity(pointer + "/" + std::to_string(i)) : fallback;
  }
  return result;
}

std::array<double, 9> SceneReader::tensor(const std::string& pointer) const {
  std::array<double, 9> result{};
  for (std::size_t i = 0; i < 9; ++i) {
    result[i] = quantity(concat(pointer, "/", i / 3, "/", i % 3));
  }
  return result;
}

TimeTable SceneReader::table(const std::string& pointer) {
  TimeTable table;
  for (std::size_t i = 0; i < size(pointer + "/time"); ++i) {
    const std::string place = concat(pointer, "/time/", i);
    table.time.push_back(quantity(place));
    if (i > 0 && table.time[i] <= table.time[i - 1]) {
      problem(place, "time " + as_given(place) + " does not come after the one before",
              "write times that increase");
    }
  }
  for (std::size_t i = 0; i < size(pointer + "/factor"); ++i) {
    table.factor.push_back(number(concat(pointer, "/factor/", i)));
  }
  if (table.time.size() == table.factor.size()) return table;
  if (sound(pointer)) {
    problem(pointer,
            concat("has ", table.time.size(), " times but ", table.factor.size(), " factors"),
            "write one factor per time");
  }
  return {};
}

void SceneReader::problem(const std::string& pointer, const std::string& what,
                          const std::string& cure) {
  if (!said_.insert(pointer + "\n" + what).second) return;
  unsound_.add(pointer);
  problems_.push_back({pointer, document_.line_of(pointer), what, cure});
}

void SceneReader::demand_known(const std::string& pointer, const std::string& name,
                               const std::string& what, const std::vector<std::string>& known) {
  if (name.empty() || std::find(known.begin(), known.end(), name) != known.end()) return;
  problem(
      pointer, "there is no " + what + " \"" + name + "\"",
      problems_.size() < kMostSuggestions ? suggest(name, known) : "write a name that is there");
}

void SceneReader::demand_unique(const std::string& list, const std::string& suffix,
                                const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty() || seen.insert(names[i]).second) continue;
    problem(concat(list, "/", i, suffix), "the name \"" + names[i] + "\" is taken",
            "choose another name");
  }
}

std::string SceneReader::as_given(const std::string& pointer) const {
  const json* value = find(pointer);
  if (value == nullptr) return "";
  return value->is_string() ? value->get<std::string>() : value->dump();
}

std::string in_unit(double value, Dimension dimension, const std::string& unit) {
  char text[64];
  // Rounded first: 50 deg is 49.99999999999999 one way and must not print as such.
  std::snprintf(text, sizeof text, "%.6g", from_si(value, dimension, unit));
  return std::string(text) + " " + unit;
}

std::vector<std::string> region_names(const Scene& scene) {
  std::vector<std::string> names;
  if (scene.geometry_kind == GeometryKind::field) {
    for (const Block& block : scene.field.blocks) names.push_back(block.name);
  } else {
    for (const PressureRegion& region : scene.box.regions) names.push_back(region.name);
  }
  return names;
}

}  // namespace faultsim
