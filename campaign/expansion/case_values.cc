#include "campaign/expansion/case_values.h"

#include <limits>
#include <utility>

#include "campaign/common/names.h"
#include "campaign/spec/pointers.h"

namespace faultsweep {
namespace {

Value as_value(const Choice& choice) {
  if (choice.si) return *choice.si;
  return choice.text;
}

/// Whether a change puts something at a pointer, by itself or within what it puts above it.
bool sets(const Change& change, const std::string& pointer) {
  return change.pointer.size() <= pointer.size() && overlap(change.pointer, pointer);
}

/// What a change puts at a pointer; null where what it puts above it has no single value there.
/// @pre sets(change, pointer)
const nlohmann::json* value_set(const Change& change, const std::string& pointer) {
  if (change.pointer == pointer) return &change.value;
  const nlohmann::json* value =
      faultsim::value_at(change.value, std::string_view(pointer).substr(change.pointer.size()));
  return value != nullptr && value->is_primitive() && !value->is_null() ? value : nullptr;
}

}  // namespace

CaseValues::CaseValues(const CampaignSpec& spec, const Group& group) : spec_(spec), group_(group) {
  if (spec.derived.empty() && spec.exclude.empty()) return;
  for (const auto& info : faultsim::parameters({spec.scene_source, group.scene, spec.base.lines})) {
    infos_[info.pointer] = info;
    const auto parsed = faultsim::parse_quantity(info.value, info.dimension);
    if (info.is_text) {
      base_[info.pointer] = info.value;
    } else if (parsed.ok) {
      base_[info.pointer] = parsed.value;
    }
  }
  for (const Derived& one : spec.derived) derived_.push_back(sources_of(one.expression));
  for (const Exclusion& one : spec.exclude) exclude_.push_back(sources_of(one.expression));
  if (!problems_.empty()) throw InputError(spec.source, std::exchange(problems_, {}));
}

std::vector<CaseValues::Source> CaseValues::sources_of(const Expression& expression) {
  return mapped(expression.names(), [&](const std::string& name) { return source_of(name); });
}

CaseValues::Source CaseValues::source_of(const std::string& name) {
  Source source;
  for (std::size_t p = 0; p < group_.parameters.size(); ++p) {
    const Parameter& parameter = group_.parameters[p];
    if (parameter.name != name) continue;
    source.parameter = static_cast<int>(p);
    for (const Choice& choice : parameter.choices) source.choices.push_back(as_value(choice));
    source.drawn = &parameter.drawn;
    if (parameter.base.si || parameter.is_text) source.base = as_value(parameter.base);
    return source;
  }
  if (name == "group") {
    source.base = group_.name;
    return source;
  }
  std::string pointer;
  for (const SpecIdentifier& one : spec_.identifiers) {
    if (one.name == name) pointer = one.scene_pointer;
  }
  if (const auto base = base_.find(pointer); base != base_.end()) source.base = base->second;
  for (std::size_t d = 0; d < spec_.derived.size(); ++d) {
    if (spec_.derived[d].scene_pointer == pointer) source.derived = static_cast<int>(d);
  }
  if (source.derived < 0 && !pointer.empty()) follow_changes(name, pointer, source);
  return source;
}

/// Changed by a parameter of another name: a factor, a variant, a list of pointers. It may change
/// the object around the value.
void CaseValues::follow_changes(const std::string& name, const std::string& pointer,
                                Source& source) {
  const auto info = infos_.find(pointer);
  if (info == infos_.end()) return;
  for (std::size_t p = 0; p < group_.parameters.size(); ++p) {
    const Parameter& parameter = group_.parameters[p];
    bool touched = false;
    std::vector<Value> values;
    for (const Choice& choice : parameter.choices) {
      values.push_back(source.base);
      const Change* last = nullptr;
      for (const Change& change : choice.changes)
        if (sets(change, pointer)) last = &change;
      if (last == nullptr) continue;
      touched = true;
      const nlohmann::json* value = value_set(*last, pointer);
      if (value == nullptr) {
        refuse_lost(name, pointer, choice, *last);
        continue;
      }
      const std::string text = scalar_text(*value);
      const auto parsed = faultsim::parse_quantity(text, info->second.dimension);
      values.back() = info->second.is_text ? Value(text)
                      : parsed.ok          ? Value(parsed.value)
                                           : Value();
    }
    if (!touched) continue;
    source.parameter = static_cast<int>(p);
    source.choices = std::move(values);
    source.drawn = &parameter.drawn;
    return;
  }
}

/// What the case has instead is for the scene to say: it may be a default, or nothing.
void CaseValues::refuse_lost(const std::string& name, const std::string& pointer,
                             const Choice& choice, const Change& change) {
  if (contains(problems_, choice.pointer, &Problem::pointer)) return;
  problems_.push_back(
      {choice.pointer, spec_.document.line_of(choice.pointer),
       concat("replaces the whole of ", change.pointer, " without ", pointer,
              ", but an expression of the spec uses ", spelled_name(name)),
       concat("add ", pointer.substr(change.pointer.size() + 1),
              " to it, or vary only the parts of ", change.pointer, " that differ")});
}

Value CaseValues::value_of(const Source& source, const Row& row,
                           const std::vector<double>& derived) {
  if (source.derived >= 0) return derived[source.derived];
  if (source.parameter < 0) return source.base;
  const int choice = row[source.parameter];
  if (choice < 0) return source.base;
  const auto index = static_cast<std::size_t>(choice);
  if (index < source.choices.size()) return source.choices[index];
  return (*source.drawn)[index - source.choices.size()].si;
}

void CaseValues::derive(const Row& row, std::vector<double>& derived) const {
  derived.assign(spec_.derived.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t d = 0; d < spec_.derived.size(); ++d) {
    const Value value = spec_.derived[d].expression.evaluate(
        [&](std::size_t i) { return value_of(derived_[d][i], row, derived); });
    if (const auto* number = std::get_if<double>(&value)) derived[d] = *number;
  }
}

int CaseValues::excluded_by(const Row& row, const std::vector<double>& derived) const {
  for (std::size_t e = 0; e < spec_.exclude.size(); ++e) {
    const bool out = spec_.exclude[e].expression.holds(
        [&](std::size_t i) { return value_of(exclude_[e][i], row, derived); });
    if (out) return static_cast<int>(e);
  }
  return -1;
}

}  // namespace faultsweep
