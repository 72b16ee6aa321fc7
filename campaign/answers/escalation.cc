#include "campaign/answers/escalation.h"

#include <filesystem>
#include <set>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "levels_schema.h"
#include "simulator/documents/schema.h"

namespace faultsweep {

namespace {

EscalationLevel read_level(const json& value) {
  EscalationLevel level{value.at("name"), value.at("words"), value.value("condition", ""), {}};
  const std::string colour = value.value("colour", level.name);
  level.colour = named<LevelColour>(colour).value_or(LevelColour::grey);
  return level;
}

/// What the schema cannot say.
void check_levels(const faultsim::JsonDocument& document, const EscalationTable& table,
                  std::vector<Problem>& problems) {
  std::set<std::string> names;
  for (std::size_t k = 0; k < table.levels.size(); ++k) {
    const EscalationLevel& level = table.levels[k];
    const std::string at = concat("/levels/", k);
    if (k > 0 && level.condition.empty()) {
      problems.push_back({at, document.line_of(at),
                          concat("level \"", level.name, "\" has no condition"),
                          "give it one; only the first, least severe level may have none"});
    }
    if (!names.insert(level.name).second) {
      problems.push_back({at + "/name", document.line_of(at + "/name"),
                          concat("there are two levels \"", level.name, "\""),
                          "give each a name of its own"});
    }
  }
}

}  // namespace

EscalationTable default_levels() {
  return {"",
          "",
          {{"green", "χ̄ stays at or below 0.8", "", LevelColour::green},
           {"amber", "χ̄ exceeds 0.8, and the fault does not slide", "chi_bar > 0.8",
            LevelColour::amber},
           {"red", "the fault slides", "slides", LevelColour::red}}};
}

EscalationTable read_levels(const std::string& path) {
  static const faultsim::Schema schema(json::parse(faultsim::embedded::levels_schema));
  const faultsim::JsonDocument document = faultsim::read_json_file(path);
  std::vector<Problem> problems = faultsim::check_schema(document, schema);
  if (!problems.empty()) throw InputError(path, problems);
  EscalationTable table;
  table.title = document.value.value("title", "");
  table.source = std::filesystem::path(path).filename().string();
  for (const json& level : document.value.at("levels")) table.levels.push_back(read_level(level));
  check_levels(document, table, problems);
  if (!problems.empty()) throw InputError(path, problems);
  if (!table.levels.front().condition.empty()) {
    table.levels.insert(table.levels.begin(),
                        {"no level", "none of the conditions holds", "", LevelColour::grey});
  }
  return table;
}

std::vector<Held> levels_held(const std::vector<Held>& conditions) {
  std::vector<Held> levels(conditions.size(), Held::no);
  std::vector<std::size_t> possible;
  std::size_t computed = conditions.size();
  bool is_unknown = false;
  for (std::size_t k = conditions.size(); k-- > 0;) {
    if (conditions[k] == Held::no) continue;
    possible.push_back(k);
    is_unknown = is_unknown || conditions[k] == Held::unknown;
    const bool came_out = conditions[k] == Held::yes || conditions[k] == Held::undecided_yes;
    if (came_out && computed == conditions.size()) computed = k;
    if (conditions[k] == Held::yes) break;
  }
  for (const std::size_t k : possible) {
    levels[k] = possible.size() == 1 ? Held::yes
                : is_unknown         ? Held::unknown
                : k == computed      ? Held::undecided_yes
                                     : Held::undecided_no;
  }
  return levels;
}

}  // namespace faultsweep
