#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "campaign/render/answer.h"
#include "campaign/store/records.h"

namespace faultsweep {

/// The texts of a case's parameters, one for each of the campaign's; "" where it has none.
std::vector<std::string> labels_of(const CaseParameters& values,
                                   const std::vector<StoredParameter>& parameters);
/// "offset = 100 m, friction_angle = 20 deg" of the parameters that the case has.
/// @param shown  what becomes of a value's text; null = it stays.
std::string settings_of(const CaseParameters& values,
                        const std::vector<StoredParameter>& parameters,
                        std::string (*shown)(const std::string&) = nullptr);
/// The name of a parameter for people: "friction angle"; of a JSON Pointer what it leads to,
/// "pressure field: file".
std::string parameter_label(const std::string& name);

/// The unit in which all values of a parameter are given, seen one by one.
class CommonUnit {
 public:
  void add(const CaseParameter& value);
  /// "" for plain numbers; none where nothing was seen, units differ or one of the values is words.
  const std::optional<std::string>& unit() const { return unit_; }

 private:
  std::optional<std::string> unit_;
  bool differs_ = false;
};

/// The parameters of a campaign as columns of an answer, under "parameters" in JSON: numbers in the
/// unit in which all rows give them, the text as given where their units differ or they are words.
class ParameterColumns {
 public:
  /// @param rows  of all cases that the table will have.
  ParameterColumns(const std::vector<StoredParameter>& parameters,
                   const std::vector<const CaseParameters*>& rows);
  const std::vector<AnswerColumn>& columns() const { return columns_; }
  /// One for each column, behind the cells that the row has.
  void add_cells(const CaseParameters& values, std::vector<AnswerCell>& row) const;

 private:
  std::vector<AnswerColumn> columns_;
  std::vector<char> as_text_;
};

/// SI, or words.
nlohmann::json value_to_json(const CaseParameter& value);

}  // namespace faultsweep
