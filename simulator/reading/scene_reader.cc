#include "simulator/reading/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>

#include "simulator/common/near_miss.h"
#include "simulator/common/ranges.h"
#include "simulator/common/text.h"
#include "simulator/reading/read_scene.h"

namespace faultsim {
namespace {

using nlohmann::json;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// The limits of a quantity in SI; NaN where there is none.
struct Range {
  const DimensionInfo* dimension = nullptr;  ///< nullptr: the value is not a quantity.
  double above = kNaN;
  double least = kNaN;
  double most = kNaN;
};

Range make_range(const SchemaViews& views) {
  const json* key = keyword(views, "x-dimension");
  if (key == nullptr) return {};
  Range range{.dimension = dimension_named(key->get<std::string>())};
  FAULTSIM_DEMAND(range.dimension != nullptr, "dimension ", *key);
  const auto limit = [&](const char* name) {
    const std::string text = keyword_text(views, name);
    return text.empty() ? kNaN : parse_quantity(text, range.dimension->dimension).value;
  };
  range.above = limit("x-above");
  range.least = limit("x-minimum");
  range.most = limit("x-maximum");
  return range;
}

/// Made once for values whose views depend on nothing else.
const Range& range_of(const SchemaViews& views, Range& scratch) {
  if (&views != &views.front()->views) return scratch = make_range(views);
  static std::mutex mutex;
  static std::unordered_map<const SchemaRules*, Range> known;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] = known.try_emplace(views.front());
  if (is_new) place->second = make_range(views);
  return place->second;
}

/// "" when inside.
std::string out_of_range(double value, const Range& range, const SchemaViews& views) {
  constexpr double kSlack = 1e-12;  // 80 deg in rad may come out one bit larger by another unit.
  if (value <= range.above) return "is not above " + keyword_text(views, "x-above");
  if (value < range.least - kSlack * std::abs(range.least)) {
    return "is below " + keyword_text(views, "x-minimum");
  }
  if (value > range.most + kSlack * std::abs(range.most)) {
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

ParsedQuantity parse_given(const json& value, const Range& range) {
  if (!value.is_string()) return parse_quantity(value.dump(), range.dimension->dimension);
  return parse_quantity(value.get_ref<const std::string&>(), range.dimension->dimension);
}

}  // namespace

SceneReader::SceneReader(const JsonDocument& document, std::vector<Problem>& problems,
                         std::span<const std::string> members,
                         std::unordered_map<const json*, double> quantities)
    : document_(document), problems_(problems), quantities_(std::move(quantities)) {
  // Problems of quantities come after those of the schema, which decide what is sound.
  struct Leaf {
    std::string pointer;
    const json* value;
    SchemaViews views;
  };
  std::vector<Leaf> wrong;
  const auto visit = [&](const ValuePlace& place, const json& value, const SchemaViews& views) {
    if (value.is_array()) {
      const json* most = keyword(views, "maxItems");
      if (most != nullptr && value.size() > most->get<std::size_t>()) too_long_.insert(&value);
    } else if ((value.is_string() || value.is_number()) && !read_quantity(value, views)) {
      wrong.push_back({place.pointer(), &value, views});
    }
  };
  const std::vector<Problem> found = members.empty()
                                         ? check_schema(document, scene_schema(), visit)
                                         : check_members(document, scene_schema(), members, visit);
  for (const Problem& one : found) {
    unsound_.add(one.pointer);
    said_.insert(one.pointer + "\n" + one.what);
    problems_.push_back(one);
  }
  for (const Leaf& one : wrong) explain_quantity(one.pointer, *one.value, one.views);
}

bool SceneReader::read_quantity(const json& value, const SchemaViews& views) {
  Range scratch;
  const Range& range = range_of(views, scratch);
  if (range.dimension == nullptr) return !value.is_number() || !is_vanishing(value.get<double>());
  const ParsedQuantity parsed = parse_given(value, range);
  const bool fine =
      parsed.ok && out_of_range(parsed.value, range, views).empty() && !is_vanishing(parsed.value);
  if (fine) quantities_[&value] = parsed.value;
  return fine;
}

bool SceneReader::read_again(std::string_view pointer) {
  const json* value = &document_.value;
  SchemaViews scratch[2] = {schema_views(scene_schema().root(), *value), {}};
  const SchemaViews* views = &scratch[0];
  for (std::size_t depth = 1; !pointer.empty(); ++depth) {
    const std::string_view token = pointer.substr(1, pointer.find('/', 1) - 1);
    const json* child = child_at(*value, token);
    if (child == nullptr || token.find('~') != std::string_view::npos) return false;
    SchemaViews& next = scratch[depth % 2];
    views = value->is_array() ? &item_views(*views, *child, next)
                              : &member_views(*views, std::string(token), *child, next);
    value = child;
    pointer.remove_prefix(token.size() + 1);
  }
  const bool has_unit = keyword(*views, "x-dimension") != nullptr;
  if (!value->is_number() && !(has_unit && value->is_string())) return false;
  return keyword(*views, "enum") == nullptr && accepts_alone(*views, *value) &&
         read_quantity(*value, *views);
}

void SceneReader::explain_quantity(const std::string& pointer, const json& value,
                                   const SchemaViews& views) {
  Range scratch;
  const Range& range = range_of(views, scratch);
  if (range.dimension != nullptr) {
    ParsedQuantity parsed = parse_given(value, range);
    if (!parsed.ok) {
      if (const std::string unit = keyword_text(views, "x-unit"); !unit.empty()) {
        replace_all(parsed.cure, concat(" ", range.dimension->usual, "\""), " " + unit + "\"");
      }
      return problem(pointer, parsed.what, parsed.cure);
    }
    const std::string outside = out_of_range(parsed.value, range, views);
    if (!outside.empty()) {
      return problem(pointer, as_text(value) + " " + outside, range_cure(views));
    }
  }
  problem(pointer, as_text(value) + " is not zero, but too small to mean anything", "write 0");
}

const json* SceneReader::find(const std::string& pointer) const {
  const std::size_t slash = pointer.rfind('/');
  if (slash == std::string::npos) return &document_.value;
  const std::string_view above = std::string_view(pointer).substr(0, slash);
  if (above != last_.pointer) std::swap(last_, before_);
  if (above != last_.pointer) last_ = {std::string(above), value_at(document_.value, above)};
  return last_.value == nullptr
             ? nullptr
             : child_at(*last_.value, std::string_view(pointer).substr(slash + 1));
}

std::size_t SceneReader::size(const std::string& pointer) const {
  const json* value = find(pointer);
  const bool usable = value != nullptr && value->is_array() && too_long_.count(value) == 0;
  return usable ? value->size() : 0;
}

std::vector<std::string> SceneReader::keys(const std::string& pointer) const {
  std::vector<std::string> names;
  const json* value = find(pointer);
  if (value == nullptr || !value->is_object()) return names;
  for (const auto& [key, inner] : value->items())
    if (key != "comment") names.push_back(key);
  return names;
}

double SceneReader::real(const KeyPlace& place, double fallback) const {
  if (place.value == nullptr) return fallback;
  const auto found = quantities_.find(place.value);
  if (found != quantities_.end()) return found->second;
  return place.value->is_number() && is_sound(place) ? place.value->get<double>() + 0.0 : kNaN;
}

int SceneReader::integer(const KeyPlace& place, int fallback) const {
  const json* value = place.value;
  return value != nullptr && value->is_number_integer() && is_sound(place) ? value->get<int>()
                                                                           : fallback;
}

std::string SceneReader::text(const KeyPlace& place, const std::string& fallback) const {
  if (place.value == nullptr) return fallback;
  return place.value->is_string() && is_sound(place) ? place.value->get<std::string>() : "";
}

bool SceneReader::boolean(const KeyPlace& place, bool fallback) const {
  const json* value = place.value;
  return value != nullptr && value->is_boolean() ? value->get<bool>() : fallback;
}

TimeTable SceneReader::table(const std::string& pointer) {
  TimeTable table;
  for (std::size_t i = 0; i < size(pointer + "/time"); ++i) {
    const std::string place = element(pointer + "/time", i);
    table.time.push_back(real(place));
    if (i > 0 && table.time[i] <= table.time[i - 1]) {
      problem(place, "time " + as_given(place) + " does not come after the one before",
              "write times that increase");
    }
  }
  for (std::size_t i = 0; i < size(pointer + "/factor"); ++i) {
    table.factor.push_back(real(element(pointer + "/factor", i)));
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

void SceneReader::table_problems(const std::string& pointer, const std::string& name,
                                 const InputError& error) {
  for (const Problem& one : error.problems()) {
    const std::string line = one.line > 0 ? concat(" line ", one.line) : std::string();
    problem(pointer, concat(name, line, ": ", one.what), one.cure);
  }
}

void SceneReader::require_known(const std::string& pointer, const std::string& name,
                                const std::string& what, const std::vector<std::string>& known) {
  if (name.empty() || contains(known, name)) return;
  problem(pointer, "there is no " + what + " \"" + name + "\"",
          problems_.size() < kMostSuggestions ? suggest(name, known) : "write an existing name");
}

void SceneReader::require_symmetric(const std::string& pointer,
                                    const std::array<double, 9>& tensor) {
  const bool is_symmetric =
      tensor[1] == tensor[3] && tensor[2] == tensor[6] && tensor[5] == tensor[7];
  if (is_symmetric || !sound(pointer)) return;
  problem(pointer, "the stress tensor is not symmetric",
          "write the same value for xy and yx, xz and zx, yz and zy");
}

void SceneReader::require_unique(const std::string& list, const std::string& suffix,
                                 const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty() || seen.insert(names[i]).second) continue;
    problem(concat(list, "/", i, suffix), "the name \"" + names[i] + "\" is taken",
            "choose another name");
  }
}

std::string SceneReader::fault_pressure_key(std::size_t fault, const std::string& key) const {
  const std::string own = element("/faults", fault) + "/fault_pressure/" + key;
  return has(own) ? own : "/fault_pressure/" + key;
}

std::string SceneReader::as_given(const std::string& pointer) const {
  const json* value = find(pointer);
  if (value == nullptr) return "";
  return value->is_string() ? value->get<std::string>() : value->dump();
}

std::string in_unit(double value, Dimension dimension, const std::string& unit) {
  // Rounded first: 50 deg is 49.99999999999999 one way and must not print as such.
  return formatted("%.6g %s", from_si(value, dimension, unit), unit.c_str());
}

}  // namespace faultsim
