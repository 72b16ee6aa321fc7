#include "campaign/answers/tiers.h"

#include <algorithm>
#include <cmath>

#include "campaign/answers/probability.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/query/table_output.h"

namespace faultsweep {

namespace {

/// The rows of a design at a tier, in its order.
struct TierRows {
  std::vector<char> complete;
  std::vector<CaseParameters> parameters;
  std::vector<std::vector<double>> values;  ///< [answer][row].
};

/// What is asked, as columns of a campaign.
std::vector<SqlFragment> columns_of(const Store& store, const CampaignInfo& campaign,
                                    const std::vector<std::string>& metrics,
                                    const std::vector<std::string>& conditions) {
  const Selection selection = make_selection(store, campaign, "", "");
  std::vector<SqlFragment> columns;
  for (const std::string& one : metrics) {
    const ScopedMetric metric = choose_metrics(selection, one, true, false).at(0);
    if (metric.is_extensive()) refuse_mixed(store.kinds(campaign.id, {}), "--metrics", one);
    columns.push_back({metric.sql, {}});
  }
  for (const std::string& one : conditions)
    columns.push_back(parse_condition(one, campaign, selection));
  return columns;
}

TierRows read_tier(const Store& store, const CampaignInfo& campaign,
                   const std::vector<std::string>& metrics,
                   const std::vector<std::string>& conditions, TierCost& cost) {
  Store::TableQuery query;
  query.by_design_row = true;
  query.columns = columns_of(store, campaign, metrics, conditions);
  query.columns.push_back({metric_sql("seconds"), {}});
  TierRows rows;
  rows.values.resize(metrics.size() + conditions.size());
  double seconds = 0;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    rows.complete.push_back(row.complete() ? 1 : 0);
    rows.parameters.push_back(row.parameters);
    (row.complete() ? cost.n_rows : cost.n_left_out) += 1;
    for (std::size_t k = 0; k < rows.values.size(); ++k) {
      const double value = number_of(row.metrics[k]);
      rows.values[k].push_back(k < metrics.size() ? value : value == 1 ? 1 : 0);
    }
    if (row.complete()) seconds += number_of(row.metrics.back());
  });
  cost.case_seconds = cost.n_rows > 0 ? seconds / static_cast<double>(cost.n_rows) : 0;
  for (const Store::FamilyProgress& one : store.family_progress(campaign.id))
    cost.operator_seconds += one.build_seconds.value_or(0);
  return rows;
}

/// The k-th row must be the same sample at both.
void refuse_other_samples(const TierRows& low, const TierRows& high, const CampaignInfo& campaign) {
  const bool fit =
      high.parameters.size() <= low.parameters.size() &&
      std::equal(high.parameters.begin(), high.parameters.end(), low.parameters.begin());
  if (fit) return;
  throw InputError(
      "tiers", concat("the samples of ", campaign.name, " are not the first ones of the low tier"),
      "give both the same monte-carlo design and seed");
}

/// The pairs first, then what only the low tier has: of one answer.
struct PairedValues {
  std::vector<double> high, low;
};

PairedValues paired(const TierRows& low, const TierRows& high, std::size_t answer,
                    const std::string& label) {
  PairedValues pairs;
  std::vector<double> others;
  for (std::size_t row = 0; row < low.complete.size(); ++row) {
    if (low.complete[row] == 0) continue;
    const double x = low.values[answer][row];
    const bool has_both = row < high.complete.size() && high.complete[row] != 0;
    const double y = has_both ? high.values[answer][row] : 0;
    if (!std::isfinite(x) || !std::isfinite(y)) {
      throw InputError("--metrics", concat("full histories have no ", label),
                       "ask for a metric that each has, or for a condition");
    }
    if (has_both) pairs.high.push_back(y);
    (has_both ? pairs.low : others).push_back(x);
  }
  pairs.low.insert(pairs.low.end(), others.begin(), others.end());
  return pairs;
}

TierAnswer answer_of(TierAnswer asked, const PairedValues& pairs, const Tiers& tiers) {
  const double confidence = tiers.request.confidence;
  const TieredSample sample{pairs.high, pairs.low};
  TierAnswer answer = std::move(asked);
  answer.found = answer.is_probability ? tiered_probability(sample, confidence)
                                       : tiered_mean(sample, confidence);
  for (const double x : pairs.low) answer.low_mean += x / static_cast<double>(pairs.low.size());
  answer.high_alone_seconds = tiers.high_cost.seconds_of(answer.found.n_equivalent);
  if (tiers.taken_seconds > 0) answer.cost_ratio = answer.high_alone_seconds / tiers.taken_seconds;
  if (tiers.low_cost.case_seconds > 0 && tiers.high_cost.case_seconds > 0) {
    answer.best_ratio = best_ratio(answer.found.correlation,
                                   tiers.low_cost.case_seconds / tiers.high_cost.case_seconds);
  }
  return answer;
}

/// As lists of metrics have them, each with its unit.
std::vector<TierAnswer> metrics_asked(const Store& store, const CampaignInfo& campaign,
                                      const std::string& list, const Selection& selection) {
  const std::string names = list.empty() ? of_each_fault(selection.faults, "chi_bar") : list;
  const bool plane_strain = store.kinds(campaign.id, {}).plane_strain;
  std::vector<TierAnswer> asked;
  for (const ScopedMetric& one : choose_metrics(selection, names, true, false)) {
    TierAnswer answer;
    answer.label = one.spelled;
    answer.unit = shown_unit(one.dimension, plane_strain);
    asked.push_back(std::move(answer));
  }
  return asked;
}

/// Metrics, then conditions.
std::vector<TierAnswer> all_asked(const Store& store, const CampaignInfo& campaign,
                                  const TierRequest& request) {
  const Selection selection = make_selection(store, campaign, "", "");
  std::vector<TierAnswer> asked = metrics_asked(store, campaign, request.metrics, selection);
  for (const std::string& one :
       request.conditions.empty() ? default_conditions(selection) : request.conditions) {
    TierAnswer answer;
    answer.label = one;
    answer.is_probability = true;
    answer.unit = percent();
    asked.push_back(std::move(answer));
  }
  return asked;
}

}  // namespace

double TierCost::seconds_of(double rows) const { return operator_seconds + rows * case_seconds; }

Tiers compare_tiers(const Store& store, const CampaignInfo& low, const CampaignInfo& high,
                    const TierRequest& request) {
  Tiers tiers{low, high, request, 0, {}, {}, 0, {}};
  std::vector<TierAnswer> asked = all_asked(store, low, request);
  std::vector<std::string> metrics, conditions;
  for (const TierAnswer& one : asked)
    (one.is_probability ? conditions : metrics).push_back(one.label);
  const TierRows lows = read_tier(store, low, metrics, conditions, tiers.low_cost);
  const TierRows highs = read_tier(store, high, metrics, conditions, tiers.high_cost);
  refuse_other_samples(lows, highs, high);
  for (std::size_t row = 0; row < highs.complete.size(); ++row)
    tiers.n_pairs += lows.complete[row] != 0 && highs.complete[row] != 0 ? 1 : 0;
  if (tiers.n_pairs < kFewestPairsForTiers) {
    throw InputError("tiers",
                     concat(tiers.n_pairs,
                            " full histories at both tiers are "
                            "too few"),
                     concat("run at least ", kFewestPairsForTiers, ": --tier-budget"));
  }
  tiers.taken_seconds = tiers.low_cost.seconds_of(static_cast<double>(tiers.low_cost.n_rows)) +
                        tiers.high_cost.seconds_of(static_cast<double>(tiers.high_cost.n_rows));
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const PairedValues pairs = paired(lows, highs, k, asked[k].label);
    tiers.answers.push_back(answer_of(std::move(asked[k]), pairs, tiers));
  }
  return tiers;
}

}  // namespace faultsweep
