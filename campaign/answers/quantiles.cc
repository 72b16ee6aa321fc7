#include "campaign/answers/quantiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "campaign/report/table_output.h"
#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using nlohmann::json;

namespace {

/// An end that only unknown rows reach is none.
std::optional<double> if_known(const std::optional<double>& end) {
  return end && std::isfinite(*end) ? end : std::nullopt;
}

QuantileBounds bounds_with_unknown(const std::vector<double>& sorted, long n_unknown, double q,
                                   double confidence) {
  QuantileBounds bounds = quantile_bounds(sorted, q, confidence);
  if (n_unknown == 0) return bounds;
  const auto unknown = static_cast<std::size_t>(n_unknown);
  std::vector<double> all = sorted;
  all.insert(all.begin(), unknown, -std::numeric_limits<double>::infinity());
  bounds.low = if_known(quantile_bounds(all, q, confidence).low);
  all = sorted;
  all.insert(all.end(), unknown, std::numeric_limits<double>::infinity());
  bounds.high = if_known(quantile_bounds(all, q, confidence).high);
  return bounds;
}

MetricQuantiles of_metric(const ScopedMetric& metric, std::vector<double> values, long n_unknown,
                          const QuantileRequest& request) {
  MetricQuantiles found{metric, 0, 0, {}};
  const auto n_all = values.size();
  std::erase_if(values, [](double one) { return !std::isfinite(one); });
  found.n = static_cast<long>(values.size());
  found.n_without = static_cast<long>(n_all - values.size());
  if (values.empty()) return found;
  std::sort(values.begin(), values.end());
  for (const double q : request.at)
    found.values.push_back(bounds_with_unknown(values, n_unknown, q, request.confidence));
  return found;
}

}  // namespace

Quantiles find_quantiles(const Store& store, const CampaignInfo& campaign,
                         const QuantileRequest& request) {
  for (const double q : request.at) {
    if (q > 0 && q < 1) continue;
    throw InputError("--at", {{"", 0, concat(format_number(q), " is not a share of the cases"),
                               "write shares between 0 and 1: 0.05,0.5,0.95"}});
  }
  Quantiles found{campaign, request, sampling_of(store, campaign), 0, {}};
  Sample sample = read_sample(store, campaign, {request.where, "", ""}, request.metrics);
  found.n_unknown = sample.n_without + sample.n_early;
  for (std::size_t m = 0; m < sample.outputs.size(); ++m) {
    const ScopedMetric& metric = sample.outputs[m];
    if (metric.is_extensive())
      refuse_mixed(store.kinds(campaign.id, {}), "--quantiles", metric.name);
    found.metrics.push_back(of_metric(metric, std::move(sample.y[m]), found.n_unknown, request));
  }
  return found;
}

std::string quantiles_to_text(const Quantiles& q) {
  TextTable table({"metric", "unit", "share below", "value", "from", "to", "rows"});
  const auto text = [](const std::optional<double>& end) {
    return end ? format_number(*end) : std::string("open");
  };
  long n_without = 0;
  for (const MetricQuantiles& one : q.metrics) {
    n_without = std::max(n_without, one.n_without);
    for (std::size_t k = 0; k < one.values.size(); ++k) {
      const QuantileBounds& value = one.values[k];
      table.add_row({one.metric.name, faultsim::si_unit(one.metric.dimension),
                     concat(format_number(100 * q.request.at[k]), " %"),
                     format_number(value.estimate), text(value.low), text(value.high),
                     std::to_string(one.n)});
    }
  }
  std::string out = concat(table.text(), "\nBounds hold each quantile with a confidence of ",
                           format_number(100 * q.request.confidence, 4),
                           " %, whatever the distribution; open: too few cases.\n");
  if (q.n_unknown > 0)
    out += concat(q.n_unknown, " cases without a history to its end may have any value.\n");
  if (n_without > 0)
    out += concat("up to ", n_without, " full histories have no value: left out\n");
  if (!q.sampling.remark.empty()) out += q.sampling.remark + "\n";
  return out;
}

json quantiles_to_json(const Quantiles& q) {
  json metrics = json::array();
  for (const MetricQuantiles& one : q.metrics) {
    json values = json::array();
    for (std::size_t k = 0; k < one.values.size(); ++k) {
      const QuantileBounds& value = one.values[k];
      values.push_back({{"share", q.request.at[k]},
                        {"estimate", value.estimate},
                        {"low", value.low ? json(*value.low) : json()},
                        {"high", value.high ? json(*value.high) : json()}});
    }
    metrics.push_back({{"metric", one.metric.name},
                       {"unit", faultsim::si_unit(one.metric.dimension)},
                       {"rows", one.n},
                       {"without_value", one.n_without},
                       {"quantiles", values}});
  }
  return {{"campaign", q.campaign.name},
          {"confidence", q.request.confidence},
          {"is_probability", q.sampling.is_random},
          {"remark", q.sampling.remark},
          {"unknown", q.n_unknown},
          {"metrics", metrics}};
}

}  // namespace faultsweep
