#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/answers/sensitivity.h"

/// Inside of the module: what the answers about parameters are made of.
namespace faultsweep {

// What is asked of the parameters of a campaign ---------------------------------------------------

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// The metrics of the request; by default χ̄, slip and sliding of each fault. Throws InputError
/// where they are wrong, or would mix what is per metre of strike with what is in total.
std::vector<ScopedMetric> asked_outputs(const Store& store, const CampaignInfo& campaign,
                                        const SensitivityRequest& request,
                                        const Selection& selection);

/// Whether a metric that lies between these two is the same but for rounding: within a billionth of
/// the larger, or of 1 for plain numbers, as χ̄ of a fault that nothing loads is 0 but for rounding.
/// Variances of rounding say nothing of parameters.
bool is_rounding(const ScopedMetric& metric, double least, double most);
/// Gives all values that are there the first one where they differ by rounding only.
void flatten_rounding(const ScopedMetric& metric, std::vector<double>& values);

/// Numbers and unit of a metric on a screen.
ShownUnit unit_of(const ScopedMetric& metric, bool plane_strain);

// Metrics at each load step -----------------------------------------------------------------------

struct HistoryOutputs {
  std::vector<Store::LoadStep> steps;  ///< that all cases have.
  std::vector<ScopedMetric> metrics;   ///< as asked, of a fault each.
  std::vector<ScopedMetric> outputs;   ///< metric by metric, step by step.
};

/// What a request by_step asks for. Throws InputError where a metric is none of a fault that the
/// histories keep, or where the cases do not share their load steps.
HistoryOutputs history_outputs(const Store& store, const CampaignInfo& campaign,
                               const SensitivityRequest& request, const Selection& selection);

// The numbers of a sensitivity --------------------------------------------------------------------

/// Adds Sensitivity::metrics and what belongs to them.
/// @pre all else is there, the columns of the sample too; `over_steps` has its metrics.
void add_indices(const Store& store, Sensitivity& s);

// What answers of a sensitivity have in common, by step or not ------------------------------------

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
