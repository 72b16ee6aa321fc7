#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/spec_reader.h"
#include "simulator/documents/schema.h"

namespace faultsweep {
namespace {

std::optional<NumberAndUnit> split(const json& value) { return split_quantity(scalar_text(value)); }

/// Fifteen digits: what a user would have written (0.3, not 0.30000000000000004).
std::string decimal(long double number) { return formatted("%.15Lg", number == 0 ? 0.0L : number); }

/// The value as the scene spells it: a number, or text with a unit.
json with_unit(long double number, const std::string& unit) {
  if (unit.empty()) return json::parse(decimal(number));
  return decimal(number) + " " + unit;
}

const Choice* choice_of(const Parameter& parameter, int value) {
  if (value < 0) return &parameter.base;
  const auto index = static_cast<std::size_t>(value);
  return index < parameter.choices.size() ? &parameter.choices[index] : nullptr;
}

const DrawnValue& drawn_of(const Parameter& parameter, int value) {
  return parameter.drawn[static_cast<std::size_t>(value) - parameter.choices.size()];
}

}  // namespace

std::string Parameter::text(int value) const {
  if (const Choice* choice = choice_of(*this, value)) return choice->text;
  return shortest_text(drawn_of(*this, value).number) + (range->unit.empty() ? "" : " ") +
         range->unit;
}

std::optional<double> Parameter::si(int value) const {
  if (const Choice* choice = choice_of(*this, value)) return choice->si;
  return drawn_of(*this, value).si;
}

const std::string& Parameter::place(int value) const {
  const Choice* choice = choice_of(*this, value);
  return choice != nullptr ? choice->pointer : pointer;
}

void Parameter::append_changes(int value, std::vector<Change>& changes) const {
  if (const Choice* choice = choice_of(*this, value)) {
    changes.insert(changes.end(), choice->changes.begin(), choice->changes.end());
    return;
  }
  const json spelled =
      range->unit.empty() ? json(drawn_of(*this, value).number) : json(text(value));
  for (const std::string& target : targets) changes.push_back({target, spelled});
}

void Parameter::draw(const std::vector<double>& positions) {
  const SampledRange& r = *range;
  for (const double position : positions) {
    DrawnValue one;
    one.number = std::strtod(decimal(r.marginal.quantile(position)).c_str(), nullptr);
    drawn.push_back(one);
    DrawnValue& value = drawn.back();
    value.si = r.unit.empty() ? value.number
                              : faultsim::parse_quantity(text(n_values() - 1), dimension).value;
  }
}

std::optional<Parameter> SpecReader::read_parameter(const std::string& pointer,
                                                    const std::string& name,
                                                    const SceneNames& names, DesignKind design) {
  Parameter parameter;
  parameter.name = name;
  parameter.pointer = pointer;
  const std::size_t n_problems = problems_.size();
  const json& value = at(pointer);
  if (name.empty()) {
    problem(pointer, "a parameter has an empty name", "name it after what it varies");
    return std::nullopt;
  }
  if (value.is_object() && (value.contains("scale") || value.contains("variants"))) {
    parameter.has_own_values = true;
    const bool taken =
        value.contains("scale") && contains(names.infos, name, &faultsim::ParameterInfo::alias);
    if (taken) {
      problem(pointer, "\"" + name + "\" is the name of a scene parameter",
              "a factor needs another name, for example " + name + "_factor");
    }
  }
  if (value.is_array()) {
    read_targets(names, parameter);
    if (!parameter.targets.empty()) read_values(pointer, names, parameter);
  } else {
    std::vector<std::string> found;
    for (const char* kind : {"values", "from", "scale", "variants", "distribution"}) {
      const bool is_end = value.contains("distribution") && std::string(kind) == "from";
      if (value.contains(kind) && !is_end) found.emplace_back(kind);
    }
    if (found.size() != 1) {
      const std::string what = found.empty() ? "does not say how it varies"
                                             : "has both " + found[0] + " and " + found[1];
      problem(pointer, "\"" + name + "\" " + what,
              "give one of values, from/to/count, distribution, scale/factors, variants");
    } else if (found[0] == "scale") {
      read_scale(names, parameter);
    } else if (found[0] == "variants") {
      read_variants(names, parameter);
    } else {
      read_targets(names, parameter);
      if (parameter.targets.empty()) return std::nullopt;
      if (found[0] == "values") {
        read_values(pointer + "/values", names, parameter);
      } else if (found[0] == "distribution") {
        read_distribution(names, parameter, design);
      } else {
        read_range(names, parameter, design);
      }
    }
    check_stray_keys(pointer);
  }
  if (problems_.size() > n_problems) return std::nullopt;
  return parameter;
}

/// Keys that do nothing without another one.
void SpecReader::check_stray_keys(const std::string& pointer) {
  const json& value = at(pointer);
  const bool has_distribution = value.contains("distribution");
  for (const auto& [key, owner] :
       {std::pair("to", "from"), std::pair("count", "from"), std::pair("spacing", "from"),
        std::pair("factors", "scale"), std::pair("mean", "distribution"),
        std::pair("deviation", "distribution"), std::pair("median", "distribution"),
        std::pair("factor", "distribution"), std::pair("mode", "distribution")}) {
    if (has_distribution && std::string(owner) == "from") continue;  // read_distribution sees to it
    if (value.contains(key) && !value.contains(owner)) {
      problem(pointer + "/" + key, std::string(key) + " needs " + owner,
              std::string("add ") + owner + " or remove " + key);
    }
  }
  if (value.contains("pointers") && (value.contains("scale") || value.contains("variants"))) {
    problem(pointer + "/pointers", "pointers need values or a range", "remove pointers");
  }
}

void SpecReader::read_targets(const SceneNames& names, Parameter& parameter) {
  const std::string list = parameter.pointer + "/pointers";
  if (at(parameter.pointer).is_object() && has(list)) {
    for (const auto& [key, place] : members(list)) {
      if (auto target = resolve(names, at(place).get<std::string>(), place)) {
        parameter.targets.push_back(*target);
      }
    }
  } else if (auto target = resolve(names, parameter.name, parameter.pointer)) {
    parameter.targets.push_back(*target);
  }
  if (!parameter.targets.empty()) check_change_count(parameter);
  if (!parameter.targets.empty()) set_base_choice(names, parameter);
}

/// Each value is kept with all places that it changes.
void SpecReader::check_change_count(Parameter& parameter) {
  constexpr std::size_t kMost = 1'000'000;
  const auto n_values = static_cast<std::size_t>(count_values(parameter.pointer));
  if (n_values * parameter.targets.size() <= kMost) return;
  problem(parameter.pointer,
          std::to_string(n_values) + " values for " + std::to_string(parameter.targets.size()) +
              " places",
          "their product may be at most " + std::to_string(kMost) + "; use fewer of either");
  parameter.targets.clear();
}

void SpecReader::set_base_choice(const SceneNames& names, Parameter& parameter) {
  const std::string& target = parameter.targets.front();
  parameter.base.pointer = "/base";
  if (const auto* info = names.find(target)) {
    parameter.dimension = info->dimension;
    parameter.base.text = info->value;
    parameter.is_text = info->is_text;
    if (info->is_text) return;
    const auto parsed = faultsim::parse_quantity(info->value, info->dimension);
    if (parsed.ok) parameter.base.si = parsed.value;
    return;
  }
  const json* value = faultsim::value_at(names.document.value, target);
  if (value == nullptr) return;
  parameter.base.text = scalar_text(*value);
  if (value->is_number()) parameter.base.si = value->get<double>();
}

std::optional<Choice> SpecReader::make_choice(const json& value, const std::string& pointer,
                                              const SceneNames& names, const Parameter& parameter) {
  Choice choice;
  choice.text = value.is_structured() ? value.dump() : scalar_text(value);
  choice.pointer = pointer;
  const auto* info = names.find(parameter.targets.front());
  if (info != nullptr && !info->is_text) {
    const auto parsed = faultsim::parse_quantity(choice.text, parameter.dimension);
    if (!parsed.ok) {
      problem(pointer, parsed.what, parsed.cure);
      return std::nullopt;
    }
    choice.si = parsed.value;
  } else if (value.is_number() && !parameter.is_text) {
    choice.si = value.get<double>();
  }
  for (const std::string& target : parameter.targets) choice.changes.push_back({target, value});
  return choice;
}

void SpecReader::read_values(const std::string& pointer, const SceneNames& names,
                             Parameter& parameter) {
  std::unordered_set<std::string> seen;
  for (const auto& [key, place] : members(pointer)) {
    const json& value = at(place);
    // 1 and 1.0 are one value: whole numbers are read as such however they are written.
    if (!seen.insert(value.dump()).second) {
      problem(place, "the value " + faultsim::as_text(value) + " is given twice", "remove one");
      continue;
    }
    auto choice = make_choice(value, place, names, parameter);
    if (!choice) continue;
    if (!choice->si) parameter.is_text = true;
    parameter.choices.push_back(std::move(*choice));
  }
  unify_kind(parameter);
}

/// Words and numbers mixed are words.
void SpecReader::unify_kind(Parameter& parameter) {
  if (!parameter.is_text) return;
  for (Choice& choice : parameter.choices) choice.si.reset();
  parameter.base.si.reset();
}

void SpecReader::read_range(const SceneNames& names, Parameter& parameter, DesignKind design) {
  const std::string& pointer = parameter.pointer;
  const bool drawn = is_sampled(design) && !has(pointer + "/count");
  if (!has(pointer + "/to") || (!has(pointer + "/count") && !drawn)) {
    problem(pointer, "the range of \"" + parameter.name + "\" is incomplete",
            is_sampled(design) ? "give from and to" : "give from, to and count");
    return;
  }
  const auto from = make_choice(at(pointer + "/from"), pointer + "/from", names, parameter);
  const auto to = make_choice(at(pointer + "/to"), pointer + "/to", names, parameter);
  if (!from || !to) return;
  const auto first = split(at(pointer + "/from"));
  const auto last = split(at(pointer + "/to"));
  if (!first || !last || !from->si || !to->si) {
    problem(pointer + "/from", "a range needs two numbers", "list the values instead");
    return;
  }
  if (*from->si == *to->si) {
    problem(pointer + "/to", "the range is empty: from and to are equal", "give two values");
    return;
  }
  const long double end =
      first->unit == last->unit
          ? last->number
          : static_cast<long double>(faultsim::from_si(*to->si, parameter.dimension, first->unit));
  const bool log = has(pointer + "/spacing") && at(pointer + "/spacing") == "log";
  if (log && (first->number <= 0 || end <= 0)) {
    problem(pointer + "/spacing", "a log range needs values above zero", "write \"linear\"");
    return;
  }
  if (drawn) {
    parameter.choices = {*from, *to};
    const Distribution distribution = log ? Distribution::log_uniform : Distribution::uniform;
    parameter.range = SampledRange{{distribution, first->number, end}, first->unit};
    return;
  }
  const int count = at(pointer + "/count").get<int>();
  parameter.choices.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const long double t = static_cast<long double>(i) / (count - 1);
    long double number = log ? first->number * std::pow(end / first->number, t)
                             : first->number + (end - first->number) * t;
    if (i == 0) number = first->number;
    if (i == count - 1) number = end;
    auto choice = make_choice(with_unit(number, first->unit), pointer, names, parameter);
    if (!choice) return;
    parameter.choices.push_back(std::move(*choice));
  }
}

/// The keys that a distribution needs; `from` and `to` cut the others too.
std::vector<std::string> keys_of(const std::string& distribution) {
  if (distribution == "normal") return {"mean", "deviation"};
  if (distribution == "log-normal") return {"median", "factor"};
  return {"mode", "from", "to"};
}

/// Keys of a distribution that are missing, and those that belong to others.
bool SpecReader::check_distribution_keys(const std::string& pointer) {
  const std::string kind = at(pointer + "/distribution");
  const std::vector<std::string> needed = keys_of(kind);
  const std::size_t before = problems_.size();
  for (const std::string& key : needed) {
    if (!has(pointer + "/" + key)) problem(pointer, "a " + kind + " needs " + key, "add " + key);
  }
  for (const std::string key :
       {"mean", "deviation", "median", "factor", "mode", "count", "spacing"}) {
    if (!has(pointer + "/" + key) || contains(needed, key)) continue;
    problem(pointer + "/" + key, "a " + kind + " has no " + key, "remove it");
  }
  return problems_.size() == before;
}

void SpecReader::read_distribution(const SceneNames& names, Parameter& parameter,
                                   DesignKind design) {
  const std::string& pointer = parameter.pointer;
  if (!is_sampled(design)) {
    problem(pointer + "/distribution", "nothing is drawn in a " + std::string(to_string(design)),
            "use monte-carlo, latin-hypercube, sobol or morris");
    return;
  }
  if (!check_distribution_keys(pointer)) return;
  const std::string kind = at(pointer + "/distribution");
  const std::string centre_key = keys_of(kind).front();
  std::string unit;
  bool is_sound = true;
  const auto number = [&](const std::string& key) -> long double {  // in the unit of the centre
    const std::string place = pointer + "/" + key;
    const auto choice = make_choice(at(place), place, names, parameter);
    const auto parts = choice && choice->si ? split(at(place)) : std::nullopt;
    if (choice && !parts) problem(place, "a distribution needs numbers", "list the values instead");
    is_sound = is_sound && parts;
    if (!is_sound) return 0;  // without a centre there is no unit
    if (key == centre_key) unit = parts->unit;
    return parts->unit == unit ? parts->number
                               : faultsim::from_si(*choice->si, parameter.dimension, unit);
  };
  constexpr long double kInfinity = std::numeric_limits<long double>::infinity();
  Marginal marginal;
  marginal.distribution = kind == "normal"       ? Distribution::normal
                          : kind == "log-normal" ? Distribution::log_normal
                                                 : Distribution::triangular;
  marginal.centre = number(centre_key);
  const bool is_log = marginal.distribution == Distribution::log_normal;
  marginal.from = has(pointer + "/from") ? number("from") : is_log ? 0 : -kInfinity;
  marginal.to = has(pointer + "/to") ? number("to") : kInfinity;
  if (is_log) marginal.spread = at(pointer + "/factor").get<double>();
  if (marginal.distribution == Distribution::normal) marginal.spread = number("deviation");
  if (!is_sound || !check_distribution(pointer, marginal, design)) return;
  parameter.range = SampledRange{marginal, unit};
  for (const auto& [u, key] : {std::pair(0, "/from"), std::pair(1, "/to")}) {
    const std::string place = pointer + (has(pointer + key) ? key : "/distribution");
    auto end = make_choice(with_unit(marginal.quantile(u), unit), place, names, parameter);
    if (end) parameter.choices.push_back(std::move(*end));
  }
}

/// What a distribution must be to be drawn from.
bool SpecReader::check_distribution(const std::string& pointer, const Marginal& m,
                                    DesignKind design) {
  constexpr long double kFar = 8;  // deviations: beyond there is nothing to draw
  const std::size_t before = problems_.size();
  const bool is_log = m.distribution == Distribution::log_normal;
  const bool is_triangle = m.distribution == Distribution::triangular;
  if (m.from >= m.to)
    problem(pointer + "/to", "the distribution is cut at a value not above from",
            "give a larger one");
  if (is_log && (m.centre <= 0 || m.from < 0))
    problem(pointer + "/median", "a log-normal distribution has only values above zero",
            "give numbers above zero");
  if (is_log && m.spread <= 1)
    problem(pointer + "/factor", "the factor of a log-normal is not above 1",
            "give a larger one: two thirds of the values lie between median / factor and median * "
            "factor");
  if (m.distribution == Distribution::normal && m.spread <= 0)
    problem(pointer + "/deviation", "the deviation is not above zero", "give a larger one");
  if (is_triangle && (m.centre < m.from || m.centre > m.to))
    problem(pointer + "/mode", "the mode is not between from and to", "give one that is");
  if (problems_.size() > before) return false;
  const auto deviations = [&](long double end) {
    return is_log ? std::log(end / m.centre) / std::log(m.spread) : (end - m.centre) / m.spread;
  };
  if (!is_triangle && (deviations(m.from) > kFar || deviations(m.to) < -kFar))
    problem(pointer + "/distribution", "no part of it lies between from and to",
            "widen the range: it is more than 8 deviations away");
  for (const int u : {0, 1}) {
    if (problems_.size() == before && !std::isfinite(static_cast<double>(m.quantile(u))))
      problem(pointer + "/distribution", "it reaches numbers that are too large",
              "give from and to, or less spread");
  }
  if (design == DesignKind::morris && (!std::isfinite(m.to) || !std::isfinite(deviations(m.from))))
    problem(pointer + "/distribution", "a morris design uses both ends, and one is missing",
            "give from and to");
  return problems_.size() == before;
}

void SpecReader::read_scale(const SceneNames& names, Parameter& parameter) {
  const std::string place = parameter.pointer + "/scale";
  if (!has(parameter.pointer + "/factors")) {
    problem(parameter.pointer, "scale needs factors", "add for example \"factors\": [0.5, 1, 2]");
    return;
  }
  struct Scaled {
    std::string pointer;
    NumberAndUnit base;
  };
  std::vector<Scaled> scaled;
  const bool many = at(place).is_array();
  for (std::size_t i = 0; i < (many ? at(place).size() : 1); ++i) {
    const std::string here = many ? place + "/" + std::to_string(i) : place;
    const auto target = resolve(names, at(here).get<std::string>(), here);
    if (!target) continue;
    const json* given = faultsim::value_at(names.document.value, *target);
    const auto* info = names.find(*target);
    json base = given != nullptr ? *given : json();
    if (base.is_null() && info != nullptr) base = info->value;
    const auto parts = base.is_primitive() && !base.is_null() ? split(base) : std::nullopt;
    if (!parts) {
      problem(here, *target + " has no number to multiply in the base scene",
              "give values instead");
      continue;
    }
    scaled.push_back({*target, *parts});
    parameter.targets.push_back(*target);
  }
  check_change_count(parameter);
  if (parameter.targets.empty()) return;
  parameter.base = {"1", 1.0, "/base", {}};
  for (const auto& [key, factor_place] : members(parameter.pointer + "/factors")) {
    Choice choice{at(factor_place).dump(), at(factor_place).get<double>(), factor_place, {}};
    const long double factor = std::strtold(choice.text.c_str(), nullptr);
    for (const Scaled& one : scaled) {
      choice.changes.push_back({one.pointer, with_unit(one.base.number * factor, one.base.unit)});
    }
    parameter.choices.push_back(std::move(choice));
  }
}

void SpecReader::read_variants(const SceneNames& names, Parameter& parameter) {
  const std::string place = parameter.pointer + "/variants";
  parameter.is_text = true;
  parameter.base = {"base", std::nullopt, "/base", {}};
  std::unordered_set<std::string> known;
  for (const auto& [variant, variant_place] : members(place)) {
    Choice choice{variant, std::nullopt, variant_place, {}};
    for (const auto& [key, here] : members(variant_place)) {
      const auto target = resolve(names, key, here);
      if (!target) continue;
      choice.changes.push_back({*target, at(here)});
      if (known.insert(*target).second) parameter.targets.push_back(*target);
    }
    parameter.choices.push_back(std::move(choice));
  }
}

}  // namespace faultsweep
