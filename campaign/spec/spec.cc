#include "campaign/spec/spec.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "campaign/common/json.h"
#include "campaign/spec/spec_reader.h"
#include "campaign_schema.h"
#include "simulator/common/input_file.h"

namespace faultsweep {
namespace {

json choice_to_json(const Choice& choice) {
  json changes = json::object();
  for (const Change& change : choice.changes) changes[change.pointer] = change.value;
  json result = {{"text", choice.text}, {"changes", changes}};
  if (choice.si) result["si"] = *choice.si;
  return result;
}

json marginal_to_json(const SampledRange& range) {
  const Marginal& m = range.marginal;
  const auto centre = static_cast<double>(m.centre), spread = static_cast<double>(m.spread);
  switch (m.distribution) {
    case Distribution::uniform:
      return {{"spacing", "linear"}};
    case Distribution::log_uniform:
      return {{"spacing", "log"}};
    case Distribution::normal:
      return {{"distribution", "normal"},
              {"mean", centre},
              {"deviation", spread},
              {"unit", range.unit}};
    case Distribution::log_normal:
      return {{"distribution", "log-normal"},
              {"median", centre},
              {"factor", spread},
              {"unit", range.unit}};
    case Distribution::triangular:
      return {{"distribution", "triangular"}, {"mode", centre}, {"unit", range.unit}};
  }
  FAULTSIM_DEMAND(false, static_cast<int>(m.distribution));
  return {};
}

json parameter_to_json(const Parameter& parameter) {
  json result = {{"name", parameter.name},
                 {"unit", faultsim::si_unit(parameter.dimension)},
                 {"base", parameter.base.text}};
  if (parameter.range) {
    const Choice& from = parameter.choices.front();
    const Choice& to = parameter.choices.back();
    result["range"] = {{"from", from.text},
                       {"to", to.text},
                       {"from_si", *from.si},
                       {"to_si", *to.si},
                       {"pointers", parameter.targets}};
    if (parameter.range->is_given) {
      result["range"]["unit"] = parameter.range->unit;
    } else {
      result["range"].update(marginal_to_json(*parameter.range));
    }
    return result;
  }
  result["choices"] = json::array();
  for (const Choice& choice : parameter.choices) {
    result["choices"].push_back(choice_to_json(choice));
  }
  return result;
}

/// What a design has besides its parameters.
json design_to_json(const Design& design) {
  json result = {{"kind", to_string(design.kind)}};
  if (design.kind == DesignKind::list) result["rows"] = design.rows;
  if (is_of_file(design.kind)) {
    result.update({{"file", design.file},
                   {"fingerprint", design.fingerprint},
                   {"samples", design.rows.size()}});
  }
  if (design.kind == DesignKind::places) result["names"] = design.names;
  if (!is_sampled(design.kind)) return result;
  result["seed"] = design.seed;
  result[design.kind == DesignKind::morris ? "trajectories" : "samples"] = design.n;
  if (design.kind == DesignKind::morris) result["levels"] = design.levels;
  if (design.kind == DesignKind::monte_carlo) result["first"] = design.first;
  if (design.kind == DesignKind::sobol) result["second_order"] = design.second_order;
  if (design.correlated) {
    result["correlated"] = {{"parameters", design.correlated->parameters},
                            {"rank", design.correlated->rank}};
  }
  return result;
}

json group_to_json(const Group& group) {
  json result;
  if (group.designs.size() == 1) {
    result = design_to_json(group.designs.front());
  } else {
    result["kind"] = "nested";
    for (const Design& design : group.designs) {
      result["designs"].push_back(design_to_json(design));
      result["designs"].back()["n_parameters"] = design.n_parameters;
    }
  }
  result["name"] = group.name;
  result["scene"] = group.scene;
  result["parameters"] = json::array();
  for (const Parameter& parameter : group.parameters) {
    result["parameters"].push_back(parameter_to_json(parameter));
  }
  return result;
}

json policy_to_json(const Policy& policy) {
  json result = {{"on_failure", to_string(policy.on_failure)}, {"retries", policy.retries}};
  if (policy.time_limit) result["time_limit_s"] = *policy.time_limit;
  if (policy.operator_time_limit) result["operator_time_limit_s"] = *policy.operator_time_limit;
  if (policy.memory_limit) result["memory_limit_bytes"] = *policy.memory_limit;
  return result;
}

}  // namespace

bool is_sampled(DesignKind kind) {
  return kind == DesignKind::monte_carlo || kind == DesignKind::latin_hypercube ||
         kind == DesignKind::sobol || kind == DesignKind::morris;
}

std::string CampaignSpec::resolved() const {
  json result = {{"format", 1},
                 {"name", name},
                 {"title", title},
                 {"policy", policy_to_json(policy)},
                 {"rank_by", rank_by},
                 {"exclude", json::array()},
                 {"derived", json::array()},
                 {"groups", json::array()}};
  // Only where it says something: specs that were stored before the key existed stay the same.
  if (keep_fields != KeepFields::shown) result["keep_fields"] = to_string(keep_fields);
  if (operators.kind != OperatorPolicy::Kind::exact) {
    result["operators"] = {{"policy", to_string(operators.kind)},
                           {"tolerance", operators.tolerance}};
  }
  if (const auto& staged = staged_sample) {
    result["rounds"] = {{"probability_of", staged->condition},
                        {"width", staged->width},
                        {"confidence", staged->confidence},
                        {"most_samples", staged->most}};
  }
  for (const LimitSearch& one : limits) {
    result["limits"].push_back({{"parameter", one.name},
                                {"faults", one.faults},
                                {"stage", one.stage},
                                {"unsafe", one.unsafe},
                                {"tolerance", one.tolerance},
                                {"unit", one.unit}});
  }
  for (const Exclusion& one : exclude) result["exclude"].push_back(one.text);
  for (const Derived& one : derived) {
    result["derived"].push_back({{"pointer", one.scene_pointer}, {"expression", one.text}});
  }
  for (const Group& group : groups) result["groups"].push_back(group_to_json(group));
  return result.dump(1);
}

CampaignSpec read_campaign(const std::string& path) {
  CampaignSpec spec =
      parse_campaign(faultsim::read_input_or_throw(path, faultsim::kMostJsonBytes), path);
  if (faultsim::value_at(spec.document.value, "/operators/exact_rows") != nullptr) {
    throw InputError(path,
                     {{"/operators/exact_rows", spec.document.line_of("/operators/exact_rows"),
                       "is only for `rank --certify`, which adds it itself", "remove it"}});
  }
  if (spec.document.value.contains("limits_round")) {
    throw InputError(path,
                     {{"/limits_round", spec.document.line_of("/limits_round"),
                       "is only for the search for limits, which adds it itself", "remove it"}});
  }
  return spec;
}

bool is_plain_name(const std::string& name) {
  const auto is_letter_or_digit = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return !name.empty() && is_letter_or_digit(name[0]) && std::ranges::all_of(name, [&](char c) {
    return is_letter_or_digit(c) || c == '.' || c == '-' || c == '_';
  });
}

CampaignSpec parse_campaign(const std::string& text, const std::string& source) {
  return SpecReader(text, source).read();
}

const faultsim::Schema& campaign_schema() {
  static const faultsim::Schema schema(json::parse(faultsim::embedded::campaign_schema));
  return schema;
}

bool overlap(const std::string& a, const std::string& b) {
  const std::string& inner = a.size() < b.size() ? b : a;
  const std::string& outer = a.size() < b.size() ? a : b;
  return inner.compare(0, outer.size(), outer) == 0 &&
         (inner.size() == outer.size() || inner[outer.size()] == '/');
}

std::string scalar_text(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::optional<NumberAndUnit> split_quantity(const std::string& text) {
  char* end = nullptr;
  const long double number = std::strtold(text.c_str(), &end);
  if (end == text.c_str() || !std::isfinite(number)) return std::nullopt;
  std::string unit(end);
  unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
  return NumberAndUnit{number, unit};
}

json spelled(double number, const std::string& unit) {
  return unit.empty() ? json(number) : json(shortest_text(number) + " " + unit);
}

std::string shortest_text(double number) {
  const bool plain = number == 0 || (std::abs(number) >= 1e-4 && std::abs(number) < 1e9);
  char digits[64];
  const auto [end, error] =
      std::to_chars(digits, digits + sizeof digits, number,
                    plain ? std::chars_format::fixed : std::chars_format::scientific);
  FAULTSIM_DEMAND(error == std::errc(), number);
  return {digits, end};
}

}  // namespace faultsweep
