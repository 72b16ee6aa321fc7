#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/statistics/intervals.h"

namespace faultsweep {

struct ProbabilityRequest {
  std::string condition = {};  ///< as of `rank --where`; "" = sliding of each fault in each stage.
  std::string where = {};      ///< of which cases; "" = all.
  std::string by = {};         ///< a parameter: for each of its values, or ten parts of its range.
  double confidence = 0.95;
  double width = 0;  ///< wanted distance of the bounds, in (0, 1]; 0 = not asked.
};

/// How often something holds. Rows whose case has no history to its end may be either: the bounds
/// reach from none of them to all.
struct Share {
  std::string label;   ///< the condition, or the values of the parameter that it is for.
  long n = 0;          ///< rows.
  long n_unknown = 0;  ///< of these: without a history to its end.
  long n_holds = 0;
  double estimate = 0;  ///< of those known; NaN where none is.
  Interval bounds;      ///< Clopper & Pearson's.
  /// Rows that bounds as far apart as ProbabilityRequest::width would take beyond those there are,
  /// if the share stays as it is; 0 = none, or not asked, or no row is known.
  long n_more = 0;
};

struct Probability {
  CampaignInfo campaign;
  ProbabilityRequest request;
  Sampling sampling;
  std::vector<Share> shares;
  /// Rows that a half width of half the present one would take; 0 = not asked of several shares.
  long n_for_half = 0;
  long n_unresolved =
      0;  ///< rows whose activation or event depends on the mesh; counted as they are.
};

/// Throws InputError on a wrong condition or parameter, and where no case was selected.
Probability find_probability(const Store& store, const CampaignInfo& campaign,
                             const ProbabilityRequest& request);

/// What is asked where no condition is given: "F2.slides in gas_storage" for each fault and stage,
/// and for the whole history.
std::vector<std::string> default_conditions(const Selection& selection);

std::string probability_to_text(const Probability& probability);
nlohmann::json probability_to_json(const Probability& probability);

}  // namespace faultsweep
