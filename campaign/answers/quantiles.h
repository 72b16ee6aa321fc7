#pragma once

#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/render/answer.h"
#include "campaign/statistics/intervals.h"

namespace faultsweep {

struct QuantileRequest {
  std::string metrics = {};                    ///< names with commas.
  std::vector<double> at = {0.05, 0.5, 0.95};  ///< shares in (0, 1).
  std::string where = {};                      ///< of which cases; "" = all.
  double confidence = 0.95;
};

/// Quantiles of a metric, in SI.
struct MetricQuantiles {
  ScopedMetric metric;
  long n = 0;          ///< rows with a value.
  long n_without = 0;  ///< full histories without one, such as the magnitude of no event: left out.
  long n_unresolved = 0;  ///< full histories of which the cells leave it open.
  double error = 0;       ///< its largest, measured or stated by the tier; 0 = not known.
  /// Per QuantileRequest::at; none where no row has a value. Of a random sample with bounds that
  /// hold whatever the distribution and whatever is undecided. Of other designs there is no
  /// distribution: the order statistic of what was run, that is the smallest of its values that no
  /// less than this share of the rows do not exceed, without bounds.
  std::vector<QuantileBounds> values;
};

struct Quantiles {
  CampaignInfo campaign;
  QuantileRequest request;
  Sampling sampling;
  long n_unknown = 0;  ///< rows without a history to its end.
  std::vector<MetricQuantiles> metrics;
  bool plane_strain = false;  ///< areas, potencies and moments are per metre of strike.
};

/// Rows without a history to its end, and those whose value the cells leave open, may have any
/// value: the lower bound is that with all of them below, the upper one that with all of them
/// above, and each is further away by its error. The quantile itself is of what was
/// computed. Throws InputError on wrong metrics or shares.
Quantiles find_quantiles(const Store& store, const CampaignInfo& campaign,
                         const QuantileRequest& request);

/// Table `quantiles`, a row for each metric and share; on the screen a table for each unit.
Answer to_answer(const Quantiles& quantiles);

}  // namespace faultsweep
