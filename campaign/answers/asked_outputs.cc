#include "campaign/answers/sensitivity_parts.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/names.h"

namespace faultsweep {

std::vector<ScopedMetric> asked_outputs(const Store& store, const CampaignInfo& campaign,
                                        const SensitivityRequest& request,
                                        const Selection& selection) {
  std::string names = request.metrics;
  for (const char* metric : {"chi_bar", "max_slip", "slides"}) {
    if (request.metrics.empty())
      names += (names.empty() ? "" : ",") + of_each_fault(selection.faults, metric);
  }
  std::vector<ScopedMetric> outputs = choose_metrics(selection, names, true, false);
  const Store::Kinds kinds = kinds_of(store, campaign, selection, request.cases.where);
  for (const ScopedMetric& one : outputs)
    if (one.is_extensive()) refuse_mixed(kinds, "--metrics", one.name);
  return outputs;
}

bool is_rounding(const ScopedMetric& metric, double least, double most) {
  constexpr double kRounding = 1e-9;
  const double size = std::max(std::abs(least), std::abs(most));
  const bool is_number = metric.dimension == Dimension::number;
  return most - least <= kRounding * (is_number ? std::max(size, 1.0) : size);
}

void flatten_rounding(const ScopedMetric& metric, std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity(), most = -least, first = kNoNumber;
  for (const double one : values) {
    if (!std::isfinite(one)) continue;
    if (std::isnan(first)) first = one;
    least = std::min(least, one), most = std::max(most, one);
  }
  if (std::isnan(first) || !is_rounding(metric, least, most)) return;
  for (double& one : values)
    if (std::isfinite(one)) one = first;
}

ShownUnit unit_of(const ScopedMetric& metric, bool plane_strain) {
  return shown_unit(metric.dimension, plane_strain && metric.is_extensive());
}

}  // namespace faultsweep
