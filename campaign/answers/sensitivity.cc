#include "campaign/answers/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "campaign/answers/designs.h"

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

/// Var E[y | x] / Var y of a grid, in which every value of x goes with the same others: the
/// variance of the means at each value. Zero where y does not vary. Without error or bounds.
Estimate share_of_levels(const std::vector<double>& y, const std::vector<double>& x, double mean) {
  std::map<double, std::pair<double, double>> levels;  // sum of y, and how many
  double all = 0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    auto& [sum, n] = levels[x[k]];
    sum += y[k] - mean, n += 1;
    all += (y[k] - mean) * (y[k] - mean);
  }
  double between = 0;
  for (const auto& [value, level] : levels) between += level.first * level.first / level.second;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {all > 0 ? between / all : 0, kNone, {kNone, kNone}};
}

/// Of the sample's parameters, in the order in which each sorts them.
using Orders = std::vector<std::vector<std::uint32_t>>;

MetricSensitivity of_metric(std::size_t m, const Sensitivity& s, const Orders& orders) {
  const Sample& sample = s.sample;
  const std::vector<double>& all = sample.y[m];
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < all.size(); ++row)
    if (std::isfinite(all[row])) rows.push_back(row);
  MetricSensitivity found{sample.outputs[m], static_cast<long>(rows.size()), 0, 0, {}};
  const bool has_all = rows.size() == all.size();
  const std::vector<double> y = has_all ? all : values_at(all, rows);
  if (y.empty()) return found;
  const auto n = static_cast<double>(y.size());
  found.mean = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double squares = 0;
  for (const double value : y) squares += (value - found.mean) * (value - found.mean);
  found.standard_deviation = std::sqrt(squares / std::max(1.0, n - 1));
  const double confidence = s.request.confidence;
  for (std::size_t p = 0; p < sample.x.size(); ++p) {
    if (has_all && !s.sampling.is_factorial) {
      found.first_order.push_back(first_order_by_ranks(y, orders[p], confidence));
      continue;
    }
    const std::vector<double> x = values_at(sample.x[p], rows);
    found.first_order.push_back(s.sampling.is_factorial
                                    ? share_of_levels(y, x, found.mean)
                                    : first_order_by_ranks(y, random_tied_order(x), confidence));
  }
  return found;
}

/// Sensitivity::dependence. What is drawn independently depends on each other where cases are left
/// out by their parameters.
std::string dependence_of(const Store& store, const CampaignInfo& campaign,
                          const SensitivityRequest& request) {
  const std::vector<json> designs = designs_of(store, campaign);
  const auto any = [&](const auto& holds) {
    return std::any_of(designs.begin(), designs.end(), holds);
  };
  if (any([](const json& one) { return one.contains("correlated"); }))
    return "Inputs are correlated";
  if (any([](const json& one) { return one.at("kind") == "samples"; }))
    return "Inputs are samples of a file and may be correlated";
  const json spec = json::parse(store.spec_copies(campaign.id).resolved);
  if (spec.at("groups").size() > 1)
    return "Groups of cases are taken together, so that inputs may be correlated";
  if (!spec.value("exclude", json::array()).empty())
    return "Cases are excluded, so that inputs are correlated";
  if (!request.cases.where.empty()) return "Some cases are selected, so that inputs are correlated";
  return "";
}

}  // namespace

Sensitivity analyse_sensitivity(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request) {
  Sensitivity s{campaign, request, sampling_of(store, campaign), {}, {}, {}};
  const std::string metrics =
      request.metrics.empty() ? default_metrics(store, campaign) : request.metrics;
  s.sample = read_sample(store, campaign, request.cases, metrics);
  refuse_what_is_no_sample(s);
  const Store::Kinds kinds = store.kinds(campaign.id, {});
  s.plane_strain = kinds.plane_strain;
  for (const ScopedMetric& one : s.sample.outputs)
    if (one.is_extensive()) refuse_mixed(kinds, "--metrics", one.name);
  s.dependence = dependence_of(store, campaign, request);
  Orders orders;
  for (const std::vector<double>& x : s.sample.x) orders.push_back(random_tied_order(x));
  for (const StoredParameter& one : s.sample.parameters) s.parameters.push_back(one.name);
  for (std::size_t m = 0; m < s.sample.outputs.size(); ++m)
    s.metrics.push_back(of_metric(m, s, orders));
  s.sample.x.clear(), s.sample.y.clear();
  if (const auto rows = read_sobol_rows(store, campaign, request.cases, s.sample.outputs)) {
    s.frozen = rows->parameters;
    s.n_base_samples = rows->n_base_samples;
    for (std::size_t m = 0; m < s.metrics.size(); ++m) {
      s.metrics[m].sobol = indices_by_pick_freeze(rows->outputs[m], request.confidence);
      s.metrics[m].n_base_samples = static_cast<long>(rows->outputs[m].a.size());
    }
  }
  return s;
}

}  // namespace faultsweep
