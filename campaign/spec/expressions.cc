#include <algorithm>
#include <cctype>

#include "campaign/spec/metrics.h"
#include "campaign/spec/spec_reader.h"

namespace faultsweep {
namespace {

using faultsim::ParameterInfo;

Type type_of(const ParameterInfo& info) {
  return info.is_text ? Type{Kind::text, {}} : number_type(info.dimension);
}

}  // namespace

void SpecReader::add_identifier(SpecIdentifier one) {
  if (!symbols_.emplace(one.name, Symbol{"", one.type}).second) return;
  spec_.identifiers.push_back(std::move(one));
}

/// Names of the designs' parameters first, then the aliases of every scene that a group has.
void SpecReader::collect_identifiers() {
  for (const Group& group : spec_.groups) {
    for (const Parameter& parameter : group.parameters) {
      const Type type = parameter.is_text ? Type{Kind::text, {}} : number_type(parameter.dimension);
      const bool own = parameter.has_own_values || parameter.targets.empty();
      add_identifier({parameter.name, own ? "" : parameter.targets.front(), type});
      if (symbols_.at(parameter.name).type == type) continue;
      problem(parameter.pointer,
              "\"" + parameter.name + "\" is a different kind of value in another group",
              "give one of the two another name");
    }
  }
  for (const Group& group : spec_.groups) {
    for (const ParameterInfo& info : names_of(group.scene).infos) {
      if (!info.alias.empty()) add_identifier({info.alias, info.pointer, type_of(info)});
    }
  }
  add_identifier({"group", "", Type{Kind::text, {}}});
}

/// A scene parameter may have more aliases than the one that is listed; those used are added.
void SpecReader::add_other_aliases(const std::string& text) {
  const SceneNames& names = names_of(spec_.groups.front().scene);
  const auto in_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  for (auto begin = text.begin(); begin != text.end();) {
    begin = std::find_if(begin, text.end(), in_name);
    const auto end = std::find_if_not(begin, text.end(), in_name);
    const std::string word(begin, end);
    begin = end;
    // Not an alias: a unit, a function, or a mistake that the parser will explain.
    const auto alias = names.aliases.find(word);
    if (alias == names.aliases.end()) continue;
    if (const auto* info = names.find(alias->second)) {
      add_identifier({word, alias->second, type_of(*info)});
    }
  }
}

/// Conditions are evaluated for each case: what they cost is the product of both.
bool SpecReader::check_expression_length() {
  constexpr long double kMost = 3e8L;  // characters; seconds
  constexpr std::size_t kMostText = 100'000;
  std::size_t length = 0;
  for (const char* section : {"/exclude", "/derived"}) {
    if (!is_usable(section)) continue;
    for (const auto& text : at(section)) {
      if (text.is_string()) length += text.get_ref<const std::string&>().size();
    }
  }
  const long double work = static_cast<long double>(length) * n_cases_;
  if (length <= kMostText && work <= kMost) return true;
  problem(has("/exclude") ? "/exclude" : "/derived",
          "exclude and derived have " + std::to_string(length) +
              " characters, to be evaluated for " +
              std::to_string(static_cast<long long>(n_cases_)) + " cases",
          "they may have 100000, and 3e8 divided by the number of cases; exclude by shorter "
          "conditions");
  return false;
}

std::optional<Expression> SpecReader::parse(const std::string& pointer, const Symbols& known) {
  try {
    return Expression::parse(at(pointer).get<std::string>(), known);
  } catch (const ExpressionError& error) {
    for (const auto& one : error.problems()) problem(pointer, one.what, one.cure);
  }
  return std::nullopt;
}

void SpecReader::read_derived() {
  if (!has("/derived")) return;
  const SceneNames& names = names_of(spec_.groups.front().scene);
  for (const auto& [key, place] : members("/derived")) {
    const auto target = resolve(names, key, place);
    add_other_aliases(at(place).get<std::string>());
    auto expression = parse(place, symbols_);
    if (!target || !expression) continue;
    const auto* info = names.find(*target);
    if (info == nullptr || info->is_text) {
      problem(place, *target + " is not a number of the scene",
              "faultsim parameters lists what can be derived");
      continue;
    }
    const Type type = expression->type();
    if (type != number_type(info->dimension)) {
      const std::string is = type.kind == Kind::number ? describe(type.units) : "not a number";
      problem(
          place,
          "the expression is " + is + ", but " + key + " is " + describe(units_of(info->dimension)),
          "make the dimensions agree");
    }
    for (const Group& group : spec_.groups) {
      for (const Parameter& parameter : group.parameters) {
        for (const std::string& other : parameter.targets) {
          if (!overlap(other, *target)) continue;
          problem(place, "\"" + key + "\" is derived, but \"" + parameter.name + "\" varies it too",
                  "remove one");
        }
      }
    }
    spec_.derived.push_back(
        {key, place, *target, expression->text(), info->dimension, std::move(*expression)});
  }
  sort_derived();
}

/// Puts each derived parameter after those that it uses.
void SpecReader::sort_derived() {
  const auto pointer_of = [&](const std::string& name) {
    for (const SpecIdentifier& one : spec_.identifiers) {
      if (one.name == name) return one.scene_pointer;
    }
    return std::string();
  };
  std::vector<Derived> sorted;
  std::vector<Derived> left = std::move(spec_.derived);
  while (!left.empty()) {
    const auto ready = std::ranges::find_if(left, [&](const Derived& one) {
      return std::ranges::none_of(left, [&](const Derived& other) {
        const auto& used = one.expression.names();
        return std::ranges::any_of(
            used, [&](const std::string& name) { return pointer_of(name) == other.scene_pointer; });
      });
    });
    if (ready == left.end()) {
      for (const Derived& one : left) {
        problem(one.pointer, "\"" + one.name + "\" is derived from itself",
                "break the circle of derived parameters");
      }
      break;
    }
    sorted.push_back(std::move(*ready));
    left.erase(ready);
  }
  spec_.derived = std::move(sorted);
}

void SpecReader::read_exclusions() {
  if (!has("/exclude")) return;
  for (const auto& [key, place] : members("/exclude")) {
    add_other_aliases(at(place).get<std::string>());
    auto expression = parse(place, symbols_);
    if (!expression) continue;
    if (expression->type().kind != Kind::boolean) {
      problem(place, "the expression is not a condition",
              "compare something, for example offset > 100 m");
      continue;
    }
    spec_.exclude.push_back({expression->text(), place, std::move(*expression)});
  }
}

void SpecReader::read_rank_by() {
  if (!has("/metrics/rank_by")) return;
  Symbols metrics;
  for (const MetricInfo& metric : metric_catalogue()) {
    const Type type = metric.is_flag ? Type{Kind::boolean, {}} : number_type(metric.dimension);
    metrics[metric.name] = {"", type};
    if (!metric.synonym.empty()) metrics[metric.synonym] = {"", type};
  }
  if (const auto expression = parse("/metrics/rank_by", metrics)) {
    if (expression->type().kind == Kind::text) {
      problem("/metrics/rank_by", "the expression is text", "rank by a number");
    }
    spec_.rank_by = expression->text();
  }
}

}  // namespace faultsweep
