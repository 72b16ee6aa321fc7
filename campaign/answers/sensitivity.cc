#include "campaign/answers/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using nlohmann::json;

namespace {

/// χ̄, slip and sliding of each fault.
std::string default_metrics(const Store& store, const CampaignInfo& campaign) {
  std::string names;
  for (const char* metric : {"chi_bar", "max_slip", "slides"}) {
    for (const NamedId& fault : store.faults(campaign.id))
      names += concat(names.empty() ? "" : ",", spelled_name(fault.name), ".", metric);
  }
  return names;
}

void refuse_what_is_no_sample(const Sensitivity& s) {
  if (!s.sampling.is_random && !s.sampling.is_factorial) {
    throw InputError(
        "sensitivity",
        {{"", 0, concat("the cases of ", s.campaign.name, " are not a sample of its parameters"),
          "give its spec a design monte-carlo, latin-hypercube, sobol or grid"}});
  }
  const long n = s.sample.n_rows - s.sample.n_without - s.sample.n_early;
  if (n < kFewestRows) {
    throw InputError("sensitivity", {{"", 0, concat(n, " cases with a full history are too few"),
                                      concat("run at least ", kFewestRows)}});
  }
}

/// The rows of x that have a y, in their order by x.
std::vector<double> values_at(const std::vector<double>& values,
                              const std::vector<std::uint32_t>& rows) {
  std::vector<double> chosen;
  chosen.reserve(rows.size());
  for (const std::uint32_t row : rows) chosen.push_back(values[row]);
  return chosen;
}

MetricSensitivity of_metric(const ScopedMetric& metric, const std::vector<double>& all,
                            const Sample& sample,
                            const std::vector<std::vector<std::uint32_t>>& orders,
                            double confidence) {
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < all.size(); ++row)
    if (std::isfinite(all[row])) rows.push_back(row);
  MetricSensitivity found{metric, static_cast<long>(rows.size()), 0, 0, {}};
  const bool has_all = rows.size() == all.size();
  const std::vector<double> y = has_all ? all : values_at(all, rows);
  if (y.empty()) return found;
  const auto n = static_cast<double>(y.size());
  found.mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double squares = 0;
  for (const double value : y) squares += (value - found.mean) * (value - found.mean);
  found.standard_deviation = std::sqrt(squares / std::max(1.0, n - 1));
  for (std::size_t p = 0; p < sample.x.size(); ++p) {
    found.first_order.push_back(
        has_all
            ? first_order_by_ranks(y, orders[p], confidence)
            : first_order_by_ranks(y, random_tied_order(values_at(sample.x[p], rows)), confidence));
  }
  return found;
}

std::string with_error(const Estimate& estimate) {
  char text[48];
  std::snprintf(text, sizeof text, "%.2f ± %.2f", estimate.value + 0.0,
                0.5 * (estimate.bounds.high - estimate.bounds.low));
  return text;
}

}  // namespace

Sensitivity analyse_sensitivity(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request) {
  Sensitivity s{campaign, request, sampling_of(store, campaign), {}, {}, {}};
  const std::string metrics =
      request.metrics.empty() ? default_metrics(store, campaign) : request.metrics;
  s.sample = read_sample(store, campaign, request.cases, metrics);
  refuse_what_is_no_sample(s);
  for (const ScopedMetric& one : s.sample.outputs)
    if (one.is_extensive()) refuse_mixed(store.kinds(campaign.id, {}), "--metrics", one.name);
  std::vector<std::vector<std::uint32_t>> orders;
  for (const std::vector<double>& x : s.sample.x) orders.push_back(random_tied_order(x));
  for (const StoredParameter& one : s.sample.parameters) s.parameters.push_back(one.name);
  for (std::size_t m = 0; m < s.sample.outputs.size(); ++m) {
    s.metrics.push_back(
        of_metric(s.sample.outputs[m], s.sample.y[m], s.sample, orders, request.confidence));
  }
  s.sample.x.clear(), s.sample.y.clear();
  if (const auto rows = read_sobol_rows(store, campaign, request.cases, s.sample.outputs)) {
    s.frozen = rows->parameters;
    for (std::size_t m = 0; m < s.metrics.size(); ++m) {
      s.metrics[m].sobol = indices_by_pick_freeze(rows->outputs[m], request.confidence);
      s.metrics[m].n_base_samples = static_cast<long>(rows->outputs[m].a.size());
    }
  }
  return s;
}

namespace {

/// Total indices where the design gives them; "" elsewhere.
std::string totals_to_text(const Sensitivity& s) {
  if (s.frozen.empty()) return "";
  std::vector<std::string> header = {"metric"};
  header.insert(header.end(), s.frozen.begin(), s.frozen.end());
  header.emplace_back("base samples");
  TextTable table(header);
  for (const MetricSensitivity& one : s.metrics) {
    if (!(one.standard_deviation > 0)) continue;
    std::vector<std::string> row = {one.metric.name};
    for (const SobolIndices& indices : one.sobol) row.push_back(with_error(indices.total));
    row.push_back(std::to_string(one.n_base_samples));
    table.add_row(row);
  }
  return concat(
      "\nShare in which a parameter takes part, interactions included (total order, by "
      "pick-freeze).\n\n",
      table.text());
}

json estimate_to_json(const Estimate& e) {
  return {{"value", e.value},
          {"standard_error", e.standard_error},
          {"low", e.bounds.low},
          {"high", e.bounds.high}};
}

}  // namespace

std::string sensitivity_to_text(const Sensitivity& s) {
  std::vector<std::string> header = {"metric"};
  header.insert(header.end(), s.parameters.begin(), s.parameters.end());
  header.insert(header.end(), {"together", "rows"});
  TextTable table(header);
  bool any = false;
  std::string constant;
  for (const MetricSensitivity& one : s.metrics) {
    if (!(one.standard_deviation > 0)) {
      constant += concat(constant.empty() ? "" : ", ", one.metric.name);
      continue;
    }
    std::vector<std::string> row = {one.metric.name};
    double together = 0;
    for (const Estimate& estimate : one.first_order) {
      row.push_back(with_error(estimate));
      together += estimate.value;
    }
    row.insert(row.end(), {format_number(together, 2), std::to_string(one.n)});
    table.add_row(row);
    any = true;
  }
  std::string text = concat(
      "Share of a metric's variance that a parameter explains alone (first order, by ranks; ± half "
      "of "
      "the interval of ",
      format_number(100 * s.request.confidence, 4),
      " %).\n"
      "What `together` leaves to 1 is interaction.\n\n");
  if (any) text += table.text();
  text += totals_to_text(s);
  if (!constant.empty()) text += concat("the same in all cases: ", constant, "\n");
  const Sample& sample = s.sample;
  text += concat("\n", sample.n_rows - sample.n_without - sample.n_early, " of ", sample.n_rows,
                 " rows; left out: ", sample.n_without, " without a result, ", sample.n_early,
                 " that end early; ", sample.n_unresolved,
                 " of these have an activation or event that the cells do not resolve\n");
  if (!s.sampling.remark.empty()) text += s.sampling.remark + "\n";
  return text;
}

json sensitivity_to_json(const Sensitivity& s) {
  json metrics = json::array();
  for (const MetricSensitivity& one : s.metrics) {
    json first_order = json::object();
    for (std::size_t p = 0; p < one.first_order.size(); ++p) {
      first_order[s.parameters[p]] = estimate_to_json(one.first_order[p]);
    }
    metrics.push_back({{"metric", one.metric.name},
                       {"rows", one.n},
                       {"mean", one.mean},
                       {"standard_deviation", one.standard_deviation},
                       {"first_order", first_order}});
    if (s.frozen.empty()) continue;
    json& frozen = metrics.back()["pick_freeze"];
    frozen["base_samples"] = one.n_base_samples;
    for (std::size_t p = 0; p < one.sobol.size(); ++p) {
      frozen["first_order"][s.frozen[p]] = estimate_to_json(one.sobol[p].first);
      frozen["total_order"][s.frozen[p]] = estimate_to_json(one.sobol[p].total);
    }
  }
  return {{"campaign", s.campaign.name},    {"confidence", s.request.confidence},
          {"rows", s.sample.n_rows},        {"without_result", s.sample.n_without},
          {"ends_early", s.sample.n_early}, {"unresolved", s.sample.n_unresolved},
          {"remark", s.sampling.remark},    {"metrics", metrics}};
}

}  // namespace faultsweep
