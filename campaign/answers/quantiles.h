#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "campaign/answers/sample.h"
#include "campaign/statistics/intervals.h"

namespace faultsweep {

struct QuantileRequest {
  std::string metrics = {};                    ///< names with commas.
  std::vector<double> at = {0.05, 0.5, 0.95};  ///< shares in (0, 1).
  std::string where = {};                      ///< of which cases; "" = all.
  double confidence = 0.95;
};

/// Quantiles of a metric, in SI, with bounds that hold whatever its distribution.
struct MetricQuantiles {
  ScopedMetric metric;
  long n = 0;          ///< rows with a value.
  long n_without = 0;  ///< full histories without one, such as the magnitude of no event: left out.
  std::vector<QuantileBounds> values;  ///< per QuantileRequest::at; none where no row has a value.
};

struct Quantiles {
  CampaignInfo campaign;
  QuantileRequest request;
  Sampling sampling;
  long n_unknown = 0;  ///< rows without a history to its end.
  std::vector<MetricQuantiles> metrics;
};

/// Rows without a history to its end may have any value: the lower bound is that with all of them
/// below, the upper one that with all of them above, and the estimate is of the others. Throws
/// InputError on wrong metrics or shares.
Quantiles find_quantiles(const Store& store, const CampaignInfo& campaign,
                         const QuantileRequest& request);

std::string quantiles_to_text(const Quantiles& quantiles);
nlohmann::json quantiles_to_json(const Quantiles& quantiles);

}  // namespace faultsweep
