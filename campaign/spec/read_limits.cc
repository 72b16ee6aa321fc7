#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/spec/spec_reader.h"

namespace faultsweep {
namespace {

/// The choices of a parameter as numbers of a unit.
std::vector<double> numbers_of(const Parameter& parameter, const std::string& unit) {
  std::vector<double> numbers;
  for (const Choice& choice : parameter.choices) {
    numbers.push_back(split_quantity(choice.text)->unit == unit
                          ? std::strtod(choice.text.c_str(), nullptr)
                          : faultsim::from_si(*choice.si, parameter.dimension, unit));
  }
  return numbers;
}

bool goes_one_way(const std::vector<double>& values) {
  for (std::size_t k = 1; k < values.size(); ++k) {
    if ((values[k] > values[k - 1]) != (values[1] > values[0])) return false;
  }
  return values.size() > 1;
}

}  // namespace

/// Cases for each row of the design.
long double SpecReader::count_scan() const {
  if (!is_usable("/limits")) return 1;
  long double count = 0;
  for (const Member& one : members("/limits")) {
    const json& parameter = at(one.pointer + "/parameter");
    if (parameter.contains("count")) count += parameter["count"].get<long double>();
    if (parameter.contains("values")) count += static_cast<long double>(parameter["values"].size());
  }
  return std::max(count, 1.0L);
}

void SpecReader::read_limits(const SceneNames& names, Group& group) {
  if (at("/design/kind") == "groups") {
    problem("/limits",
            "limits are searched for in the rows of one design, but there are several groups",
            "make a campaign of each group");
    return;
  }
  for (const Design& one : group.designs) {
    if (!is_of_file(one.kind)) continue;
    problem("/limits", "limits are searched for in rounds, and a file may change between them",
            "write the configurations into the spec, as a list");
    return;
  }
  Design design;
  design.kind = DesignKind::one_at_a_time;
  design.pointer = "/limits";
  design.without_base = true;
  const std::size_t first = group.parameters.size();
  for (const Member& one : members("/limits")) read_limit(one, names, group);
  design.n_parameters = group.parameters.size() - first;
  group.designs.push_back(std::move(design));
  if (!is_usable("/limits_round")) return;
  for (std::size_t k = first; k < group.parameters.size(); ++k) {
    Parameter& parameter = group.parameters[k];
    const std::string place = "/limits_round/values/" + faultsim::pointer_token(parameter.name);
    if (!has(place)) continue;
    parameter.choices.clear();
    read_values(place, names, parameter);
  }
  group.picked = at("/limits_round/rows").get<std::vector<long>>();
}

void SpecReader::read_limit(const Member& one, const SceneNames& names, Group& group) {
  LimitSearch search;
  search.name = one.key;
  search.pointer = one.pointer;
  const std::string& name = search.name;
  const std::string place = search.pointer + "/parameter";
  const bool is_range = at(place).contains("from") || at(place).contains("values");
  if (!is_range) {
    problem(place, "a limit is searched for among numbers", "give from, to and count, or values");
    return;
  }
  const bool is_taken = contains(group.parameters, name, &Parameter::name);
  if (is_taken) {
    problem(search.pointer, "\"" + name + "\" is a parameter of the design",
            "search along another one, or remove it from the design");
    return;
  }
  auto parameter = read_parameter(place, name, names, DesignKind::grid);
  if (!parameter) return;
  if (parameter->is_text) {
    problem(place, "a limit is searched for among numbers, and these are words", "give numbers");
    return;
  }
  search.dimension = parameter->dimension;
  search.unit = split_quantity(parameter->choices.front().text)->unit;
  search.scan = numbers_of(*parameter, search.unit);
  if (!goes_one_way(search.scan)) {
    problem(place, "the values of \"" + name + "\" do not all go one way",
            "order them, at least two, from the safe end to the dangerous one");
    return;
  }
  read(search.pointer + "/faults", search.faults);
  read(search.pointer + "/stage", search.stage);
  read(search.pointer + "/unsafe", search.unsafe);
  read_tolerance(search.pointer + "/tolerance", search);
  group.parameters.push_back(std::move(*parameter));
  spec_.limits.push_back(std::move(search));
}

void SpecReader::read_tolerance(const std::string& pointer, LimitSearch& search) {
  const auto parsed = faultsim::parse_quantity(scalar_text(at(pointer)), search.dimension);
  if (!parsed.ok) {
    problem(pointer, parsed.what, parsed.cure);
  } else if (!(parsed.value > 0)) {
    problem(pointer, "the tolerance is not above zero", "write for example \"1 bar\"");
  }
  search.tolerance = search.unit.empty()
                         ? parsed.value
                         : faultsim::from_si(parsed.value, search.dimension, search.unit);
}

}  // namespace faultsweep
