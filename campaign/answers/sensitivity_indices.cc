#include "campaign/answers/sensitivity_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "campaign/statistics/level_means.h"

namespace faultsweep {

namespace {

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
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  std::vector<std::uint32_t> levels;
  levels.reserve(x.size());
  for (const double one : x) {
    const auto at = std::ranges::lower_bound(values, one) - values.begin();
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

void set_exact(const std::vector<ExactIndices>& factors, MetricSensitivity& one) {
  for (const ExactIndices& factor : factors) {
    one.first_order.push_back(exactly(factor.first));
    one.total_order.push_back(factor.total);
  }
}

/// Of the m-th metric by step: its outputs, of all steps.
template <typename Output>
std::span<const Output> steps_of(const Sensitivity& s, const std::vector<Output>& outputs,
                                 std::size_t m) {
  return std::span(outputs).subspan(m * s.steps.size(), s.steps.size());
}

/// It carries most of what all steps together say.
const MetricSensitivity& most_varying(std::span<const MetricSensitivity> steps) {
  return *std::ranges::max_element(steps, {}, &MetricSensitivity::standard_deviation);
}

void add_grid_indices(Sensitivity& s) {
  std::vector<std::vector<std::uint32_t>> levels;
  for (const std::vector<double>& x : s.sample.x) levels.push_back(levels_of(x));
  const bool has_rows = !levels.empty() && !levels.front().empty();
  const FullGrid::Made made = has_rows ? FullGrid::make(levels) : FullGrid::Made{};
  std::vector<GridIndices> whole;  // of all outputs, where each of them has all values
  for (std::size_t m = 0; m < s.metrics.size(); ++m) {
    MetricSensitivity& one = s.metrics[m];
    const std::vector<double>& y = s.sample.y[m];
    if (one.n == 0) continue;
    if (auto exact = made.grid ? made.grid->indices(y) : std::nullopt) {
      set_exact(exact->factors, one);
      whole.push_back(std::move(*exact));
      continue;
    }
    for (const std::vector<double>& x : s.sample.x)
      one.first_order.push_back(exactly(share_of_levels(y, x, one.mean)));
  }
  for (std::size_t m = 0; m < s.over_steps.size() && whole.size() == s.metrics.size(); ++m)
    set_exact(aggregated(steps_of(s, whole, m)), s.over_steps[m]);
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
  for (std::size_t m = 0; m < s.over_steps.size(); ++m) {
    MetricSensitivity& all = s.over_steps[m];
    all.unsaid = most_varying(steps_of(s, s.metrics, m)).unsaid;
    if (all.unsaid.empty())
      all.first_order = ranks.aggregated(steps_of(s, s.sample.y, m), s.request.confidence);
  }
}

/// The outputs of a sample on all rows of a campaign that is one sobol design.
struct SobolRows {
  std::vector<std::string> parameters;    ///< in the order of PickFreezeValues::ab.
  std::vector<PickFreezeValues> outputs;  ///< of the base samples whose every row has a value.
  long n_base_samples = 0;                ///< with those that are left out.
};

/// Of an output on the rows of one base sample; they are in the order A, AB_1 .. AB_D, (BA_1 ..
/// BA_D,) B. Rows BA repeat what A and AB tell with the blocks' parts exchanged: not used.
void add_base_sample(const std::vector<double>& rows, PickFreezeValues& values) {
  if (std::ranges::any_of(rows, [](double one) { return !std::isfinite(one); })) return;
  values.a.push_back(rows.front());
  values.b.push_back(rows.back());
  for (std::size_t p = 0; p < values.ab.size(); ++p) values.ab[p].push_back(rows[p + 1]);
}

/// Nothing where the campaign is another design, or a condition selects some of its cases.
std::optional<SobolRows> read_sobol_rows(const Store& store, const CampaignInfo& campaign,
                                         const SampledCases& request,
                                         const std::vector<ScopedMetric>& outputs) {
  const std::vector<nlohmann::json> designs = designs_of(store, campaign);
  if (designs.size() != 1 || designs[0].at("kind") != "sobol" || !request.where.empty()) return {};
  SobolRows found;
  for (const nlohmann::json& one : designs[0].at("parameters"))
    found.parameters.push_back(one.at("name"));
  found.outputs.resize(outputs.size());
  for (PickFreezeValues& one : found.outputs) one.ab.resize(found.parameters.size());

  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  Store::TableQuery query = case_query(campaign, selection, "", outputs);
  query.by_design_row = true;
  const auto n_rows = static_cast<std::size_t>(rows_per_base_sample(designs[0]));
  std::vector<std::vector<double>> rows(outputs.size());  // of the base sample at hand
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    for (std::size_t m = 0; m < rows.size(); ++m) {
      rows[m].push_back(row.complete() ? number_of(row.metrics[m]) : kNoNumber);
      if (rows[m].size() < n_rows) continue;
      add_base_sample(rows[m], found.outputs[m]);
      rows[m].clear();
      found.n_base_samples += m == 0 ? 1 : 0;
    }
  });
  return found;
}

void add_pick_freeze(const Store& store, Sensitivity& s) {
  const auto rows = read_sobol_rows(store, s.campaign, s.request.cases, s.sample.outputs);
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
  for (std::size_t m = 0; m < s.over_steps.size(); ++m) {
    MetricSensitivity& all = s.over_steps[m];
    const MetricSensitivity& most = most_varying(steps_of(s, s.metrics, m));
    all.n_base_samples = most.n_base_samples;
    if (!most.sobol.empty())
      all.sobol = aggregated_by_pick_freeze(steps_of(s, rows->outputs, m), s.request.confidence);
  }
}

/// What is said of all steps together but for its indices.
void spread_over_steps(Sensitivity& s) {
  for (std::size_t m = 0; m < s.over_steps.size(); ++m) {
    MetricSensitivity& all = s.over_steps[m];
    double variance = 0;
    all.n = s.metrics[m * s.steps.size()].n, all.mean = kNoNumber;
    for (const MetricSensitivity& one : steps_of(s, s.metrics, m)) {
      variance += one.standard_deviation * one.standard_deviation;
      all.n = std::min(all.n, one.n);
    }
    all.standard_deviation = std::sqrt(variance / static_cast<double>(s.steps.size()));
  }
}

}  // namespace

void add_indices(const Store& store, Sensitivity& s) {
  for (std::size_t m = 0; m < s.sample.outputs.size(); ++m) {
    flatten_rounding(s.sample.outputs[m], s.sample.y[m]);
    s.metrics.push_back(spread_of(s.sample.outputs[m], s.sample.y[m]));
  }
  spread_over_steps(s);
  if (s.sampling.is_factorial) {
    add_grid_indices(s);
  } else {
    add_rank_indices(s);
    add_pick_freeze(store, s);
  }
}

}  // namespace faultsweep
