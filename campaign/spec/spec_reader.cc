#include "campaign/spec/spec_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"
#include "simulator/common/near_miss.h"
#include "simulator/common/process_memory.h"
#include "simulator/reading/csv_tables.h"

namespace faultsweep {

using faultsim::JsonDocument;

SceneNames::SceneNames(JsonDocument scene) : document(std::move(scene)) {
  infos = faultsim::parameters(document);
  aliases = faultsim::parameter_aliases(document);
  for (std::size_t i = 0; i < infos.size(); ++i) places_.emplace(infos[i].pointer, i);
}

const faultsim::ParameterInfo* SceneNames::find(const std::string& scene_pointer) const {
  const auto found = places_.find(scene_pointer);
  return found == places_.end() ? nullptr : &infos[found->second];
}

namespace {

/// nlohmann's ordered objects look at every key to add one: 10^5 would take minutes.
void require_small_objects(const JsonDocument& document, const nlohmann::json& value,
                           const std::string& pointer) {
  constexpr std::size_t kMost = 2000;
  if (value.is_object() && value.size() > kMost) {
    throw InputError(document.source,
                     {{pointer, document.line_of(pointer), concat("has ", value.size(), " entries"),
                       concat("write at most ", kMost)}});
  }
  for (const auto& [key, inner] : value.items()) {
    if (inner.is_structured())
      require_small_objects(document, inner, pointer + "/" + faultsim::pointer_token(key));
  }
}

/// Bytes of "8 GB", "512 MiB"; nothing when it is nothing of the kind.
std::optional<double> parse_bytes(const std::string& text) {
  static constexpr std::array<std::pair<const char*, double>, 9> kUnits = {{
      {"B", 1.0},
      {"kB", 1e3},
      {"MB", 1e6},
      {"GB", 1e9},
      {"TB", 1e12},
      {"KiB", 1024.0},
      {"MiB", 1024.0 * 1024},
      {"GiB", 1024.0 * 1024 * 1024},
      {"TiB", 1024.0 * 1024 * 1024 * 1024},
  }};
  const std::size_t blank = text.find(' ');
  if (blank == std::string::npos) return std::nullopt;
  const auto number = faultsim::parse_quantity(text.substr(0, blank), Dimension::number);
  const std::string unit = text.substr(std::min(text.find_first_not_of(' ', blank), text.size()));
  for (const auto& [name, factor] : kUnits) {
    if (unit == name && number.ok && number.value > 0) return number.value * factor;
  }
  return std::nullopt;
}

}  // namespace

SpecReader::SpecReader(const std::string& text, const std::string& source) {
  spec_.source = source;
  spec_.given = text;
  spec_.document = faultsim::parse_json(text, source);
  require_small_objects(spec_.document, spec_.document.value, "");
  ordered_ = nlohmann::ordered_json::parse(text);
}

CampaignSpec SpecReader::read() {
  check_schema();
  read_name();
  if (is_usable("/policy")) read_policy();
  if (is_usable("/base")) read_base();
  if (spec_.base.value.is_object() && is_sound("/set") && is_usable("/design") &&
      check_group_count() && check_count()) {
    json scene = spec_.base.value;
    std::vector<Origin> origins;
    if (has("/set")) apply_set("/set", scene, origins);
    read_designs("/design", "", scene, origins);
    collect_identifiers();
    if (check_expression_length()) {
      if (is_usable("/derived")) read_derived();
      if (is_usable("/exclude")) read_exclusions();
    }
    embed_tables();
  }
  if (is_usable("/rounds") && is_usable("/design")) read_rounds();
  if (has("/rounds") && has("/limits")) {
    problem("/limits", "a campaign has rounds or limits, not both",
            "make a campaign of each; cases that both have are computed once");
  }
  if (is_usable("/metrics")) read_rank_by();
  if (is_usable("/keep_fields")) {
    spec_.keep_fields = named<KeepFields>(at("/keep_fields").get<std::string>()).value();
  }
  if (is_usable("/operators")) read_operators();
  if (!problems_.empty()) throw InputError(spec_.source, problems_);
  return std::move(spec_);
}

void SpecReader::read_operators() {
  const json& operators = at("/operators");
  spec_.operators.kind = named<OperatorPolicy::Kind>(operators.value("policy", "exact")).value();
  spec_.operators.tolerance = operators.value("tolerance", spec_.operators.tolerance);
  const auto rows = operators.find("exact_rows");
  if (rows == operators.end() || spec_.groups.empty()) return;
  spec_.operators.for_comparison = true;
  spec_.groups.front().picked = rows->get<std::vector<long>>();
}

/// The text of the CSV files of a scene becomes part of it, and of a pressure field what tells that
/// it is still the same: what is read now is what the cases are.
void SpecReader::embed_tables() {
  const auto names_a_table = [](const Change& change) {
    return overlap(change.pointer, "/pressure_csv") || overlap(change.pointer, "/compartments") ||
           overlap(change.pointer, "/pressure_field") ||
           overlap(change.pointer, "/temperature_field") ||
           overlap(change.pointer, "/fault_pressure") || overlap(change.pointer, "/faults");
  };
  for (Group& group : spec_.groups) {
    const auto embed = [&](const json& scene) {
      for (const std::string& name : faultsim::table_names(scene)) {
        faultsim::embed_table(group.scene, spec_.scene_source, name);
      }
      faultsim::embed_fields(group.scene, spec_.scene_source, scene);
    };
    embed(json(group.scene));
    for (const Parameter& parameter : group.parameters) {
      for (const Choice& choice : parameter.choices) {
        json scene;
        for (const Change& change : choice.changes) {
          if (!names_a_table(change)) continue;
          if (scene.is_null()) scene = group.scene;
          faultsim::put_value(scene, change.pointer, change.value);
        }
        embed(scene);
      }
    }
  }
}

/// The rest of the reader relies on the shape that the schema promises, so it looks only at
/// sections that are there and sound: a key that is misspelt is missing too.
void SpecReader::check_schema() {
  problems_ = faultsim::check_schema(spec_.document, campaign_schema());
  for (const Problem& one : problems_) said_.insert(one.pointer + "\n" + one.what);
  const bool is_incomplete = contains(problems_, "", &Problem::pointer);
  if (is_incomplete) throw InputError(spec_.source, problems_);
}

bool SpecReader::is_sound(const std::string& pointer) const {
  return std::ranges::none_of(problems_,
                              [&](const Problem& one) { return overlap(pointer, one.pointer); });
}

bool SpecReader::is_usable(const std::string& pointer) const {
  return has(pointer) && is_sound(pointer);
}

void SpecReader::problem(const std::string& pointer, const std::string& what,
                         const std::string& cure) {
  if (!said_.insert(pointer + "\n" + what).second) return;
  problems_.push_back({pointer, spec_.document.line_of(pointer), what, cure});
}

const nlohmann::json& SpecReader::at(const std::string& pointer) const {
  const json* value = faultsim::value_at(spec_.document.value, pointer);
  FAULTSIM_DEMAND(value != nullptr, pointer);
  return *value;
}

bool SpecReader::has(const std::string& pointer) const {
  return faultsim::value_at(spec_.document.value, pointer) != nullptr;
}

std::vector<SpecReader::Member> SpecReader::members(const std::string& pointer) const {
  std::vector<Member> result;
  for (const auto& [key, value] :
       ordered_.at(nlohmann::ordered_json::json_pointer(pointer)).items()) {
    if (key != "comment") result.push_back({key, pointer + "/" + faultsim::pointer_token(key)});
  }
  return result;
}

void SpecReader::read_name() {
  if (is_usable("/name")) {
    spec_.name = at("/name").get<std::string>();
    if (!is_plain_name(spec_.name)) {
      problem("/name", "\"" + spec_.name + "\" is not a valid name for a campaign", kPlainNameCure);
    }
  }
  if (is_usable("/title")) read("/title", spec_.title);
}

void SpecReader::read_base() {
  const json& base = at("/base");
  if (base.is_object()) {
    spec_.base_is_inline = true;
    spec_.scene_source = spec_.source;
    spec_.base.source = spec_.source;
    spec_.base.value = base;
    for (const auto& [pointer, line] : spec_.document.lines) {
      if (overlap("/base", pointer) && pointer.size() >= 5) {
        spec_.base.lines[pointer.substr(5)] = line;
      }
    }
    return;
  }
  const std::filesystem::path file =
      std::filesystem::path(spec_.source).parent_path() / base.get<std::string>();
  spec_.scene_source = file.string();
  try {
    spec_.base = faultsim::read_json_file(spec_.scene_source);
    if (!spec_.base.value.is_object()) problem("/base", "the base scene is not an object", "");
  } catch (const InputError& error) {
    for (const Problem& one : error.problems()) {
      problem("/base",
              faultsim::format_problems(error.source(), {{one.pointer, one.line, one.what, ""}}),
              one.cure);
    }
  }
}

constexpr double kLeastTimeLimit = 1;  // s

std::optional<double> SpecReader::read_time_limit(const std::string& pointer) {
  if (!has(pointer)) return std::nullopt;
  const auto text = at(pointer).get<std::string>();
  const auto parsed = faultsim::parse_quantity(text, Dimension::time);
  if (!parsed.ok) {
    problem(pointer, parsed.what, "write for example \"10 min\"");
  } else if (parsed.value <= 0) {
    problem(pointer, "\"" + text + "\" is not above zero", "write for example \"10 min\"");
  } else if (parsed.value < kLeastTimeLimit) {
    problem(pointer, "\"" + text + "\" is too short a limit to enforce",
            "write at least \"1 s\": processes are checked a few times a second");
  }
  return parsed.value;
}

void SpecReader::read_policy() {
  if (!has("/policy")) return;
  Policy& policy = spec_.policy;
  if (has("/policy/on_failure"))
    policy.on_failure = named<FailureAction>(at("/policy/on_failure").get<std::string>()).value();
  read("/policy/retries", policy.retries);
  if (has("/policy/retries") && policy.on_failure != FailureAction::retry) {
    problem("/policy/retries", "retries have no effect without on_failure retry",
            "write \"on_failure\": \"retry\" or remove retries");
  }
  policy.time_limit = read_time_limit("/policy/time_limit");
  policy.operator_time_limit = read_time_limit("/policy/operator_time_limit");
  if (has("/policy/memory_limit")) {
    const auto text = at("/policy/memory_limit").get<std::string>();
    policy.memory_limit = parse_bytes(text);
    if (!policy.memory_limit) {
      problem("/policy/memory_limit", "\"" + text + "\" is not an amount of memory",
              "write for example \"8 GB\"");
    } else if (*policy.memory_limit < faultsim::kLeastMemoryLimit) {
      problem("/policy/memory_limit",
              "\"" + text + "\" is less than a simulator process needs before its first case",
              "write at least \"" + std::to_string(std::lround(faultsim::kLeastMemoryLimit / 1e6)) +
                  " MB\"");
    }
  }
}

/// What the condition may name is known with the faults and stages of a scene (campaign/rounds).
void SpecReader::read_rounds() {
  StagedSample& staged = spec_.staged_sample.emplace();
  read("/rounds/probability_of", staged.condition);
  read("/rounds/width", staged.width);
  read("/rounds/confidence", staged.confidence);
  read("/rounds/most_samples", staged.most);
  if (at("/design/kind") != "monte-carlo") {
    problem("/rounds", "the design is not a monte-carlo design, whose samples can be continued",
            "write \"kind\": \"monte-carlo\", or remove rounds");
  } else if (staged.most < at("/design/samples").get<long>()) {
    problem("/rounds/most_samples", "is less than the samples of the design",
            "write at least " + at("/design/samples").dump());
  }
}

void SpecReader::apply_set(const std::string& pointer, json& scene, std::vector<Origin>& origins) {
  // Each alias is looked up in the scene as the keys before it left it: "/friction" may come first.
  std::optional<std::map<std::string, std::string>> aliases;
  for (const auto& [key, place] : members(pointer)) {
    std::string target = key;
    if (key.empty() || key[0] != '/') {
      if (!aliases) aliases = faultsim::parameter_aliases({spec_.base.source, scene, {}});
      const auto resolved = resolve(*aliases, key, place);
      if (!resolved) continue;
      target = *resolved;
    }
    if (!faultsim::put_value(scene, target, at(place))) {
      problem(place, "the base scene has no place " + target,
              "faultsim parameters lists what can be set");
      continue;
    }
    aliases.reset();
    origins.push_back({target, place});
  }
}

std::optional<std::string> SpecReader::resolve(const std::map<std::string, std::string>& aliases,
                                               const std::string& alias,
                                               const std::string& spec_pointer) {
  if (!alias.empty() && alias[0] == '/') return alias;
  const auto found = aliases.find(alias);
  if (found != aliases.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [name, pointer] : aliases) known.push_back(name);
  std::string near;
  if (problems_.size() < faultsim::kMostSuggestions) near = faultsim::near_miss(alias, known);
  // A list of every alias of the scene would bury the other problems.
  problem(spec_pointer, "there is no parameter \"" + alias + "\"",
          near.empty() ? "`faultsim parameters SCENE.json` lists them; a name of your own needs "
                         "pointers, scale or variants"
                       : "did you mean \"" + near + "\"?");
  return std::nullopt;
}

const SceneNames& SpecReader::names_of(const json& scene) {
  if (!names_ || names_->document.value != scene) {
    names_.emplace(JsonDocument{spec_.base.source, scene, spec_.base.lines});
  }
  return *names_;
}

}  // namespace faultsweep
