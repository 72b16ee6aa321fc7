#pragma once

#include <string>
#include <vector>

#include "simulator/common/units.h"

namespace faultsweep {

/// A number (or flag) per case and stage that `rank` can order and filter by.
struct MetricInfo {
  std::string name;  ///< field of faultsim::StageMetrics or CaseResult.
  faultsim::Dimension dimension;
  bool is_flag = false;
  std::string description;
  bool may_be_missing = false;  ///< cases with a full history may have no value.
};

/// All metrics of `rank --list-metrics`, in the order shown.
const std::vector<MetricInfo>& metric_catalogue();

}  // namespace faultsweep
