#pragma once

#include <string>
#include <vector>

#include "campaign/answers/shares.h"
#include "campaign/render/answer.h"

namespace faultsweep {

struct ProbabilityRequest {
  std::string condition = {};  ///< as of `rank --where`; "" = sliding of each fault in each stage.
  std::string where = {};      ///< of which cases; "" = all.
  std::string by = {};         ///< a parameter: for each of its values, or parts of its range.
  double confidence = 0.95;
  double width = 0;  ///< wanted distance of the bounds, in (0, 1]; 0 = not asked.
};

/// How often something holds.
struct Share {
  std::string label;  ///< the condition, or the values of the parameter that it is for.
  std::string condition;
  ShareCounts counts;
  Interval bounds;  ///< see bounds_of.
  /// Rows that bounds as far apart as ProbabilityRequest::width would take beyond those there are,
  /// if the share stays as it is and nothing is open; 0 = none, or not asked, or no sample.
  long n_more = 0;
};

struct Probability {
  CampaignInfo campaign;
  ProbabilityRequest request;
  Sampling sampling;
  std::vector<Share> shares;
  /// Rows that a half width of half the present one would take; 0 = not asked of several shares.
  long n_for_half = 0;
};

/// Throws InputError on a wrong condition or parameter, and where no case was selected.
Probability find_probability(const Store& store, const CampaignInfo& campaign,
                             const ProbabilityRequest& request);

/// What is asked where no condition is given: "F2.slides in gas_storage" for each fault and stage,
/// and for the whole history.
std::vector<std::string> default_conditions(const Selection& selection);

/// Shares with their bounds.
faultsim::figure::IntervalChart chart_of(const Probability& probability);
/// Table `shares`, and the chart.
Answer to_answer(const Probability& probability);

}  // namespace faultsweep
