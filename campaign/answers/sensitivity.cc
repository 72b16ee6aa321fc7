#include "campaign/answers/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "campaign/answers/asked_outputs.h"
#include "campaign/answers/designs.h"
#include "campaign/statistics/level_means.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using nlohmann::json;

namespace {

void refuse_what_is_no_sample(const Sensitivity& s) {
  if (!s.sampling.is_random && !s.sampling.is_factorial) {
    throw InputError(
        "sensitivity",
        {{"", 0, concat("the cases of ", s.campaign.name, " are not a sample of its parameters"),
          "give its spec one design monte-carlo, latin-hypercube, sobol, grid, morris or "
          "one-at-a-time"}});
  }
  const long n = s.sample.n_rows - s.sample.n_without - s.sample.n_early;
  if (n == 0) {
    throw InputError("sensitivity", {{"", 0, "no case has a history to its end",
                                      concat("run it: faultsweep run ", s.campaign.name)}});
  }
  if (s.sampling.is_random && n < kFewestForRankIndex) {
    throw InputError(
        "sensitivity",
        {{"", 0,
          concat(n, n == 1 ? " case with a full history is" : " cases with a full history are",
                 " too few: intervals of indices hold from ", kFewestForRankIndex, " on"),
          concat("run at least ", kFewestForRankIndex)}});
  }
}

/// Without error or bounds.
Estimate exactly(double value) { return {value, kNoNumber, {kNoNumber, kNoNumber}}; }

/// Var E[y | x] / Var y of what is left of a grid: the variance of the means at each value. Zero
/// where y does not vary.
double share_of_levels(const std::vector<double>& y, const std::vector<double>& x, double mean) {
  std::map<double, std::pair<double, double>> levels;  // sum of y, and how many
  double all = 0;
  for (std::size_t k = 0; k < y.size(); ++k) {
    if (!std::isfinite(y[k])) continue;
    auto& [sum, n] = levels[x[k]];
    sum += y[k] - mean, n += 1;
    all += (y[k] - mean) * (y[k] - mean);
  }
  double between = 0;
  for (const auto& [value, level] : levels) between += level.first * level.first / level.second;
  return all > 0 ? between / all : 0;
}

/// The number of each value of x, in ascending order.
std::vector<std::uint32_t> levels_of(const std::vector<double>& x) {
  std::vector<double> values = x;
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<std::uint32_t> levels;
  levels.reserve(x.size());
  for (const double one : x) {
    const auto at = std::lower_bound(values.begin(), values.end(), one) - values.begin();
    levels.push_back(static_cast<std::uint32_t>(at));
  }
  return levels;
}

/// Mean and spread of an output over the rows that have it.
MetricSensitivity spread_of(const ScopedMetric& metric, const std::vector<double>& y) {
  MetricSensitivity found{metric, 0, 0, 0, {}};
  double first = 0, sum = 0;  // of differences from the first: exact where all are the same
  for (const double one : y) {
    if (!std::isfinite(one)) continue;
    if (found.n++ == 0) first = one;
    sum += one - first;
  }
  if (found.n == 0) return found;
  found.mean = first + sum / static_cast<double>(found.n);
  double squares = 0;
  for (const double one : y)
    if (std::isfinite(one)) squares += (one - found.mean) * (one - found.mean);
  const long freedom = std::max(1L, found.n - 1);
  found.standard_deviation = std::sqrt(squares / static_cast<double>(freedom));
  return found;
}

/// "of F1.magnitude 31 rows": why intervals would not hold; "" where they do.
/// @param fewest, of_either  rows, and those with each of two values.
std::string too_few(const MetricSensitivity& one, long n, const char* what, long fewest,
                    long of_either) {
  if (n < fewest) return concat(one.metric.name, " (", n, " ", what, " of ", fewest, ")");
  if (!one.metric.is_flag || !(one.standard_deviation > 0)) return "";
  const double rarer = std::min(one.mean, 1 - one.mean);
  const long n_rarer = std::lround(rarer * static_cast<double>(one.n));
  if (n_rarer >= of_either) return "";
  return concat(one.metric.name, one.mean < 0.5 ? " (true in " : " (false in ", n_rarer,
                " rows of ", of_either, ")");
}

void add_grid_indices(Sensitivity& s) {
  std::vector<std::vector<std::uint32_t>> levels;
  for (const std::vector<double>& x : s.sample.x) levels.push_back(levels_of(x));
  const bool has_rows = !levels.empty() && !levels.front().empty();
  const FullGrid::Made made = has_rows ? FullGrid::make(levels) : FullGrid::Made{};
  for (std::size_t m = 0; m < s.metrics.size(); ++m) {
    MetricSensitivity& one = s.metrics[m];
    const std::vector<double>& y = s.sample.y[m];
    if (one.n == 0) continue;
    if (const auto exact = made.grid ? made.grid->indices(y) : std::nullopt) {
      for (const ExactIndices& factor : exact->factors) {
        one.first_order.push_back(exactly(factor.first));
        one.total_order.push_back(factor.total);
      }
      continue;
    }
    for (const std::vector<double>& x : s.sample.x)
      one.first_order.push_back(exactly(share_of_levels(y, x, one.mean)));
  }
}

void add_rank_indices(Sensitivity& s) {
  const int n_threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const RankSensitivity ranks(s.sample.x, n_threads);
  auto indices = ranks.first_order(s.sample.y, s.request.confidence, n_threads);
  for (std::size_t m = 0; m < s.metrics.size(); ++m) {
    MetricSensitivity& one = s.metrics[m];
    one.unsaid = too_few(one, one.n, "rows", kFewestForRankIndex, kFewestOfEitherValue);
    if (one.unsaid.empty()) one.first_order = std::move(indices[m]);
  }
}

void add_pick_freeze(const Store& store, const CampaignInfo& campaign, Sensitivity& s) {
  const auto rows = read_sobol_rows(store, campaign, s.request.cases, s.sample.outputs);
  if (!rows) return;
  s.frozen = rows->parameters;
  s.n_base_samples = rows->n_base_samples;
  for (std::size_t m = 0; m < s.metrics.size(); ++m) {
    MetricSensitivity& one = s.metrics[m];
    one.n_base_samples = static_cast<long>(rows->outputs[m].a.size());
    const std::string few = too_few(one, one.n_base_samples, "base samples", kFewestForPickFreeze,
                                    kFewestOfEitherValueInBlocks);
    if (few.empty()) {
      one.sobol = one.standard_deviation > 0
                      ? indices_by_pick_freeze(rows->outputs[m], s.request.confidence)
                      : std::vector<SobolIndices>(s.frozen.size());
    }
    if (one.unsaid.empty()) one.unsaid = few;
  }
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
  s.sample = read_sample(store, campaign, request.cases, asked_metrics(store, campaign, request));
  refuse_what_is_no_sample(s);
  const Store::Kinds kinds = store.kinds(campaign.id, {});
  s.plane_strain = kinds.plane_strain;
  for (const ScopedMetric& one : s.sample.outputs)
    if (one.is_extensive()) refuse_mixed(kinds, "--metrics", one.name);
  s.dependence = dependence_of(store, campaign, request);
  for (const StoredParameter& one : s.sample.parameters) s.parameters.push_back(one.name);
  for (std::size_t m = 0; m < s.sample.outputs.size(); ++m) {
    flatten_rounding(s.sample.outputs[m], s.sample.y[m]);
    s.metrics.push_back(spread_of(s.sample.outputs[m], s.sample.y[m]));
  }
  if (s.sampling.is_factorial) {
    add_grid_indices(s);
  } else {
    add_rank_indices(s);
    add_pick_freeze(store, campaign, s);
  }
  s.sample.x.clear(), s.sample.y.clear();
  return s;
}

}  // namespace faultsweep
