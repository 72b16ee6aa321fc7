#include "campaign/query/parameters.h"

#include "campaign/common/json.h"
#include "campaign/common/names.h"

namespace faultsweep {

namespace {

const StoredParameter& of(const CaseParameter& value,
                          const std::vector<StoredParameter>& parameters) {
  const auto index = static_cast<std::size_t>(value.index);
  if (index < parameters.size()) return parameters[index];
  throw StorageError(concat("a case of the store has a parameter number ", value.index,
                            ", which its campaign does not have"));
}

/// The unit in which all rows give the parameter, "" for plain numbers; none where they differ or
/// one of them is words.
std::optional<std::string> common_unit(const std::vector<const CaseParameters*>& rows, int index) {
  CommonUnit unit;
  for (const CaseParameters* row : rows)
    for (const CaseParameter& one : *row)
      if (one.index == index) unit.add(one);
  return unit.unit();
}

}  // namespace

std::vector<std::string> labels_of(const CaseParameters& values,
                                   const std::vector<StoredParameter>& parameters) {
  std::vector<std::string> labels(parameters.size());
  for (const CaseParameter& one : values)
    labels[&of(one, parameters) - parameters.data()] = one.text;
  return labels;
}

std::string settings_of(const CaseParameters& values,
                        const std::vector<StoredParameter>& parameters,
                        std::string (*shown)(const std::string&)) {
  std::string text;
  for (const CaseParameter& one : values) {
    if (one.text.empty()) continue;
    text += concat(text.empty() ? "" : ", ", of(one, parameters).name, " = ",
                   shown != nullptr ? shown(one.text) : one.text);
  }
  return text;
}

std::string parameter_label(const std::string& name) {
  std::string label;
  for (const char c : name.substr(name.starts_with('/') ? 1 : 0)) {
    if (c == '/')
      label += ": ";
    else
      label += c == '_' ? ' ' : c;
  }
  return label;
}

void CommonUnit::add(const CaseParameter& value) {
  const std::size_t blank = value.text.find(' ');
  const std::string own = blank == std::string::npos ? "" : value.text.substr(blank + 1);
  differs_ = differs_ || !value.si || unit_.value_or(own) != own;
  unit_ = differs_ ? std::nullopt : std::optional(own);
}

ParameterColumns::ParameterColumns(const std::vector<StoredParameter>& parameters,
                                   const std::vector<const CaseParameters*>& rows) {
  constexpr int kDigits = 6;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const StoredParameter& one = parameters[k];
    const auto unit = one.is_text ? std::nullopt : common_unit(rows, static_cast<int>(k));
    AnswerColumn column{one.name, one.name, {}, kDigits, Need::always, "parameters"};
    if (!one.is_text) column.ranks = one.name;
    if (unit && !unit->empty())
      column.unit = {*unit, 1 / faultsim::from_si(1, one.dimension, *unit),
                     faultsim::si_unit(one.dimension)};
    columns_.push_back(std::move(column));
    as_text_.push_back(unit ? 0 : 1);
  }
}

void ParameterColumns::add_cells(const CaseParameters& values, std::vector<AnswerCell>& row) const {
  const std::size_t first = row.size();
  row.resize(first + columns_.size());
  for (const CaseParameter& one : values) {
    const auto k = static_cast<std::size_t>(one.index);
    if (k >= columns_.size()) continue;
    row[first + k] = as_text_[k] != 0 ? AnswerCell(one.text) : AnswerCell(one.si.value());
  }
}

nlohmann::json value_to_json(const CaseParameter& value) {
  return value.si ? json(*value.si) : json(value.text);
}

}  // namespace faultsweep
