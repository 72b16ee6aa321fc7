#include "campaign/answers/tier_rows.h"

#include <algorithm>

#include "campaign/common/names.h"
#include "campaign/query/table_output.h"

namespace faultsweep {

namespace {

bool is_same(const MetricScope& a, const MetricScope& b) {
  return a.fault == b.fault && a.stage == b.stage;
}

/// A metric of that fault and stage; both none: of the row.
ScopedMetric metric_of(const ScopedMetric& unscoped, const MetricScope& scope,
                       const Selection& selection) {
  ScopedMetric metric = unscoped;
  if (!scope.fault && !scope.stage) return metric;
  metric.scope = scope;
  metric.sql = metric_sql(metric.metric, scope, selection.stage.id);
  const auto name_in = [](const std::vector<NamedId>& all, std::int64_t id) {
    return std::ranges::find(all, id, &NamedId::id)->name;
  };
  if (scope.fault)
    metric.spelled =
        concat(spelled_name(name_in(selection.faults, *scope.fault)), ".", metric.name);
  if (scope.stage) {
    const std::string stage = name_in(selection.stages, *scope.stage);
    metric.spelled += concat(" in ", stage.empty() ? "whole_history" : spelled_name(stage));
  }
  return metric;
}

/// What is asked, as columns of a campaign: metrics, then conditions, predictors and seconds.
std::vector<SqlFragment> sql_of(const Store& store, const CampaignInfo& campaign,
                                const Selection& selection, const TierColumns& columns,
                                const VerdictColumns& verdicts) {
  std::vector<SqlFragment> all;
  for (const std::string& one : columns.metrics) {
    const ScopedMetric metric = choose_metrics(selection, one, true, false).at(0);
    if (metric.is_extensive()) refuse_mixed(store.kinds(campaign.id, {}), "--metrics", one);
    all.push_back({metric.sql, {}});
  }
  for (const SqlFragment& one : verdicts.columns()) all.push_back(one);
  for (const ScopedMetric& one : columns.predictors) all.push_back({one.sql, {}});
  all.push_back({metric_sql("seconds"), {}});
  return all;
}

}  // namespace

std::vector<ScopedMetric> predictors_of(const std::string& condition, const CampaignInfo& campaign,
                                        const Selection& selection) {
  const auto known = known_metrics(selection);
  const Expression read =
      Expression::parse(condition, result_symbols(campaign, selection), scopes_of(selection));
  std::vector<MetricScope> scopes;
  std::vector<ScopedMetric> named;
  for (const std::string& name : read.names()) {
    const auto found = known.find(name);
    if (found == known.end()) continue;  // a parameter, or a word
    const ScopedMetric& metric = found->second;
    const MetricScope scope = metric.scope.value_or(MetricScope{});
    const auto is_there = [&](const MetricScope& one) { return is_same(one, scope); };
    if (std::ranges::none_of(scopes, is_there)) scopes.push_back(scope);
    if (!metric.is_flag) named.push_back(metric);
  }
  if (scopes.empty()) scopes.emplace_back();
  std::vector<ScopedMetric> all;
  for (const MetricScope& scope : scopes)
    for (const char* name : {"chi_bar", "max_slip", "activated_area"})
      all.push_back(metric_of(known.at(name), scope, selection));
  for (const ScopedMetric& one : named)
    if (!contains(all, one.sql, &ScopedMetric::sql)) all.push_back(one);
  return all;
}

std::size_t TierColumns::place_of(const ScopedMetric& predictor) {
  const auto found = std::ranges::find(predictors, predictor.sql, &ScopedMetric::sql);
  const auto place = static_cast<std::size_t>(found - predictors.begin());
  if (found == predictors.end()) predictors.push_back(predictor);
  return place;
}

TierRows read_tier(const Store& store, const CampaignInfo& campaign, const TierColumns& columns,
                   TierCost& cost) {
  const Selection selection = make_selection(store, campaign, "", "");
  const VerdictColumns verdicts(store, campaign, selection, columns.conditions);
  const std::size_t n_metrics = columns.metrics.size(), n_conditions = columns.conditions.size();
  Store::TableQuery query;
  query.by_design_row = true;
  query.columns = sql_of(store, campaign, selection, columns, verdicts);
  TierRows rows;
  rows.values.resize(n_metrics);
  rows.held.resize(n_conditions);
  rows.predictors.resize(columns.predictors.size());
  double seconds = 0;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    rows.complete.push_back(row.complete() ? 1 : 0);
    rows.parameters.push_back(row.parameters);
    (row.complete() ? cost.n_rows : cost.n_left_out) += 1;
    for (std::size_t k = 0; k < n_metrics; ++k) rows.values[k].push_back(number_of(row.metrics[k]));
    for (std::size_t c = 0; c < n_conditions; ++c)
      rows.held[c].push_back(verdicts.held(row, c, n_metrics));
    for (std::size_t k = 0; k < rows.predictors.size(); ++k)
      rows.predictors[k].push_back(number_of(row.metrics[n_metrics + n_conditions + k]));
    if (row.complete()) seconds += number_of(row.metrics.back());
  });
  cost.case_seconds = cost.n_rows > 0 ? seconds / static_cast<double>(cost.n_rows) : 0;
  for (const Store::FamilyProgress& one : store.family_progress(campaign.id)) {
    cost.operator_seconds += one.build_seconds.value_or(0);
    ++cost.n_operators;
  }
  return rows;
}

PairedRows paired_rows(const TierRows& low, const TierRows& high) {
  PairedRows rows;
  std::vector<std::size_t> others;
  for (std::size_t row = 0; row < low.complete.size(); ++row) {
    if (low.complete[row] == 0) continue;
    const bool has_both = row < high.complete.size() && high.complete[row] != 0;
    (has_both ? rows.order : others).push_back(row);
  }
  rows.n = rows.order.size();
  rows.order.insert(rows.order.end(), others.begin(), others.end());
  return rows;
}

}  // namespace faultsweep
