#pragma once

#include <string>
#include <vector>

#include "campaign/answers/sensitivity.h"

/// Inside of the module: what answers of a sensitivity have in common, by step or not.
namespace faultsweep {

inline constexpr int kShareDigits = 3;  ///< where there is no error.

bool is_varying(const MetricSensitivity& metric);
/// It varies, and has enough rows for indices.
bool is_told(const MetricSensitivity& metric);
/// Places of the values, that of the largest first.
std::vector<std::size_t> descending_places(const std::vector<double>& values);
std::vector<double> values_of(const std::vector<Estimate>& estimates);

/// What matters most to a metric, and whether that is sure.
/// @pre is_told, of some parameter.
std::string sentence_of(const Sensitivity& s, const MetricSensitivity& metric);
AnswerCell index_cell(const Estimate& e);

/// For files: all indices, and mean and spread of the metrics. by_step a row without a step is of
/// all of them together.
AnswerTable index_table(const Sensitivity& s);
AnswerTable metric_table(const Sensitivity& s);

/// Notes below first-order indices: what they are, and what they are not.
std::vector<std::string> meaning_of(const Sensitivity& s);
/// Notes: of which rows and parameters it all is, how these were chosen and how their results came
/// about.
void add_what_they_stand_on(const Sensitivity& s, Answer& answer);
/// What JSON has beside the tables.
nlohmann::ordered_json facts_of(const Sensitivity& s, const char* kind);
/// The answer where the request is by_step.
Answer answer_by_step(const Sensitivity& s);

}  // namespace faultsweep
