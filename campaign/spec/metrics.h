#pragma once

#include <string>
#include <vector>

#include "simulator/common/units.h"

namespace faultsweep {

/// A number (or flag) per case and stage that `rank` can order and filter by.
struct MetricInfo {
  std::string name;
  faultsim::Dimension dimension = faultsim::Dimension::number;
  bool is_flag = false;
  std::string description;
  bool may_be_missing = false;  ///< cases with a full history may have no value.
  std::string synonym = {};     ///< another name in expressions; "" = none.
  /// Per metre of strike in plane strain.
  bool is_extensive() const {
    return dimension == faultsim::Dimension::area || dimension == faultsim::Dimension::moment ||
           dimension == faultsim::Dimension::potency;
  }
};

/// All metrics of `rank --list-metrics`, in the order shown: those of simulator/result/measures.h,
/// then what follows from more than one field.
const std::vector<MetricInfo>& metric_catalogue();
/// Its unit: "m2", "m2/m" where it is per metre of strike, "" for numbers.
std::string metric_unit(const MetricInfo& metric, bool plane_strain);

}  // namespace faultsweep
