#include "campaign/answers/tiers.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/answers/probability.h"
#include "campaign/report/parameters.h"
#include "campaign/report/table_output.h"
#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::InputError;
using nlohmann::json;

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
      "tiers",
      {{"", 0, concat("the samples of ", campaign.name, " are not the first ones of the low tier"),
        "give both the same monte-carlo design and seed"}});
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
      throw InputError("--metrics", {{"", 0, concat("full histories have no ", label),
                                      "ask for a metric that each has, or for a condition"}});
    }
    if (has_both) pairs.high.push_back(y);
    (has_both ? pairs.low : others).push_back(x);
  }
  pairs.low.insert(pairs.low.end(), others.begin(), others.end());
  return pairs;
}

double cost_of(const TierCost& cost, double rows) {
  return cost.operator_seconds + rows * cost.case_seconds;
}

TierAnswer answer_of(std::string label, bool is_probability, const PairedValues& pairs,
                     const Tiers& tiers) {
  const double confidence = tiers.request.confidence;
  const TieredSample sample{pairs.high, pairs.low};
  TierAnswer answer{std::move(label), is_probability, {}, 0, 0, 1};
  answer.found =
      is_probability ? tiered_probability(sample, confidence) : tiered_mean(sample, confidence);
  for (const double x : pairs.low) answer.low_mean += x / static_cast<double>(pairs.low.size());
  const double taken = cost_of(tiers.low_cost, static_cast<double>(tiers.low_cost.n_rows)) +
                       cost_of(tiers.high_cost, static_cast<double>(tiers.high_cost.n_rows));
  if (taken > 0) answer.cost_ratio = cost_of(tiers.high_cost, answer.found.n_equivalent) / taken;
  if (tiers.low_cost.case_seconds > 0 && tiers.high_cost.case_seconds > 0) {
    answer.best_ratio = best_ratio(answer.found.correlation,
                                   tiers.low_cost.case_seconds / tiers.high_cost.case_seconds);
  }
  return answer;
}

/// As lists of metrics have them.
std::vector<std::string> names_asked(const std::string& list, const Selection& selection) {
  std::vector<std::string> names;
  if (list.empty()) {
    for (const NamedId& fault : selection.faults)
      names.push_back(spelled_name(fault.name) + ".chi_bar");
    return names;
  }
  for (const ScopedMetric& one : choose_metrics(selection, list, true, false))
    names.push_back(one.spelled);
  return names;
}

}  // namespace

Tiers compare_tiers(const Store& store, const CampaignInfo& low, const CampaignInfo& high,
                    const TierRequest& request) {
  Tiers tiers{low, high, request, 0, {}, {}, {}};
  const Selection selection = make_selection(store, low, "", "");
  const std::vector<std::string> metrics = names_asked(request.metrics, selection);
  const std::vector<std::string> conditions =
      request.conditions.empty() ? default_conditions(selection) : request.conditions;
  const TierRows lows = read_tier(store, low, metrics, conditions, tiers.low_cost);
  const TierRows highs = read_tier(store, high, metrics, conditions, tiers.high_cost);
  refuse_other_samples(lows, highs, high);
  for (std::size_t row = 0; row < highs.complete.size(); ++row)
    tiers.n_pairs += lows.complete[row] != 0 && highs.complete[row] != 0 ? 1 : 0;
  if (tiers.n_pairs < kFewestPairs) {
    throw InputError("tiers", {{"", 0,
                                concat(tiers.n_pairs,
                                       " full histories at both tiers are "
                                       "too few"),
                                concat("run at least ", kFewestPairs, ": --tier-budget")}});
  }
  for (std::size_t k = 0; k < metrics.size() + conditions.size(); ++k) {
    const bool is_probability = k >= metrics.size();
    const std::string& label = is_probability ? conditions[k - metrics.size()] : metrics[k];
    tiers.answers.push_back(answer_of(label, is_probability, paired(lows, highs, k, label), tiers));
  }
  return tiers;
}

namespace {

std::string value_text(double value, bool is_probability) {
  return is_probability ? concat(format_number(100 * value, 3), " %") : format_number(value);
}

std::string verdict_of(const TierAnswer& answer) {
  if (answer.cost_ratio > 1) return concat(format_number(answer.cost_ratio, 2), " x");
  return concat("no: ", format_number(answer.cost_ratio, 2), " x");
}

std::string cost_text(const std::string& name, const TierCost& cost) {
  return concat(name, ": ", cost.n_rows, " cases of ", format_number(cost.case_seconds, 2),
                " s, operators ", format_number(cost.operator_seconds, 2), " s",
                cost.n_left_out > 0
                    ? concat("; ", cost.n_left_out, " without a history to its end left out")
                    : "",
                "\n");
}

}  // namespace

std::string tiers_to_text(const Tiers& tiers) {
  TextTable table({"at the high tier", "value", "from", "to", "its own from", "its own to",
                   "low alone", "weight", "corr.", "worth", "pays"});
  for (const TierAnswer& one : tiers.answers) {
    const auto text = [&](double value) { return value_text(value, one.is_probability); };
    const TieredEstimate& found = one.found;
    table.add_row({one.label, text(found.estimate.value), text(found.estimate.bounds.low),
                   text(found.estimate.bounds.high), text(found.direct.bounds.low),
                   text(found.direct.bounds.high), text(one.low_mean),
                   format_number(found.weight, 2), format_number(found.correlation, 3),
                   format_number(found.n_equivalent, 3), verdict_of(one)});
  }
  std::string text = table.text();
  text +=
      concat("\n", tiers.n_pairs, " cases at both tiers. Bounds have a confidence of ",
             format_number(100 * tiers.request.confidence, 4),
             " %; `its own` are of the high tier's cases alone.\n`worth`: cases of the high tier "
             "alone that would be as sure. `pays`: what these would take, over what was taken.\n");
  text += cost_text(tiers.low.name, tiers.low_cost) + cost_text(tiers.high.name, tiers.high_cost);
  return text;
}

json tiers_to_json(const Tiers& tiers) {
  const auto cost = [](const CampaignInfo& campaign, const TierCost& one) {
    return json{{"campaign", campaign.name},
                {"rows", one.n_rows},
                {"left_out", one.n_left_out},
                {"case_s", one.case_seconds},
                {"operators_s", one.operator_seconds}};
  };
  const auto estimate = [](const Estimate& one) {
    return json{{"value", one.value},
                {"standard_error", one.standard_error},
                {"low", one.bounds.low},
                {"high", one.bounds.high}};
  };
  json answers = json::array();
  for (const TierAnswer& one : tiers.answers) {
    answers.push_back({{"label", one.label},
                       {"is_probability", one.is_probability},
                       {"estimate", estimate(one.found.estimate)},
                       {"high_alone", estimate(one.found.direct)},
                       {"low_alone", one.low_mean},
                       {"weight", one.found.weight},
                       {"correlation", one.found.correlation},
                       {"worth", one.found.n_equivalent},
                       {"cost_ratio", one.cost_ratio},
                       {"pays", one.cost_ratio > 1},
                       {"best_ratio", one.best_ratio}});
  }
  return {{"confidence", tiers.request.confidence},
          {"pairs", tiers.n_pairs},
          {"low", cost(tiers.low, tiers.low_cost)},
          {"high", cost(tiers.high, tiers.high_cost)},
          {"answers", answers}};
}

}  // namespace faultsweep
