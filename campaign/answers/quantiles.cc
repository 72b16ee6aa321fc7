#include "campaign/answers/quantiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"
#include "campaign/query/ranking.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

/// The smallest of the values that no less than the share q of them do not exceed.
double order_statistic(const std::vector<double>& sorted, double q) {
  constexpr double kRounding = 1e-9;  // 0.05 of 20 is the first
  const double place = std::ceil(q * static_cast<double>(sorted.size()) - kRounding);
  return sorted[static_cast<std::size_t>(std::max(1.0, place)) - 1];
}

/// Values that there are, ascending; `resolved` those that do not hang on the cells.
struct SortedValues {
  std::vector<double> all, resolved;
};

/// The quantile of all values, between bounds that hold whatever the `n_open` others are.
QuantileBounds sampled_quantile(const SortedValues& values, long n_open, double error, double q,
                                double confidence) {
  QuantileBounds found;
  if (!values.resolved.empty()) found = quantile_bounds(values.resolved, n_open, q, confidence);
  found.estimate = quantile_bounds(values.all, 0, q, confidence).estimate;
  if (found.low) *found.low -= error;
  if (found.high) *found.high += error;
  return found;
}

/// @param unresolved  per value, 1 where the cells leave it open.
MetricQuantiles of_metric(const ScopedMetric& metric, const std::vector<double>& values,
                          const std::vector<double>& unresolved, double error,
                          const Quantiles& all) {
  MetricQuantiles found{metric, 0, 0, 0, error, {}};
  SortedValues sorted;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool is_open = unresolved[k] == 1, has_value = std::isfinite(values[k]);
    found.n_unresolved += is_open ? 1 : 0;
    if (has_value) sorted.all.push_back(values[k]);
    if (has_value && !is_open) sorted.resolved.push_back(values[k]);
  }
  found.n = static_cast<long>(sorted.all.size());
  found.n_without = static_cast<long>(values.size()) - found.n;
  if (sorted.all.empty()) return found;
  std::ranges::sort(sorted.all);
  std::ranges::sort(sorted.resolved);
  const long n_open = all.n_unknown + found.n_unresolved;
  for (const double q : all.request.at) {
    if (all.sampling.is_random) {
      found.values.push_back(sampled_quantile(sorted, n_open, error, q, all.request.confidence));
    } else {
      found.values.push_back({order_statistic(sorted.all, q), std::nullopt, std::nullopt});
    }
  }
  return found;
}

constexpr int kQuantileDigits = 3;

ShownUnit unit_of(const Quantiles& q, const MetricQuantiles& one) {
  return shown_unit(one.metric.dimension, q.plane_strain);
}

AnswerCell end_cell(const std::optional<double>& end) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return end ? AnswerCell(*end) : AnswerCell({}, kNone, "open");
}

/// All rows, or those of the metrics with a unit.
AnswerTable table_of(const Quantiles& q, const ShownUnit* only) {
  const bool is_sample = q.sampling.is_random;
  const ShownUnit unit = only != nullptr ? *only : plain();
  AnswerTable table{
      "quantiles",
      "",
      {{"metric", "metric", {}, 4, Need::always},
       {"unit", "unit"},
       {"share", is_sample ? "share below" : "of what was run", percent(), 4, Need::always},
       {"value", is_sample ? "quantile" : "have at most", unit, kQuantileDigits + 1,
        Need::always}}};
  if (is_sample) {
    table.columns.push_back({"low", "from", unit, kQuantileDigits, Need::always});
    table.columns.push_back({"high", "to", unit, kQuantileDigits, Need::always});
  }
  table.columns.push_back({"rows", "rows"});
  table.columns.push_back({"without_value", "without a value"});
  table.columns.push_back({"undecided", "undecided by cells"});
  for (const MetricQuantiles& one : q.metrics) {
    const ShownUnit own = unit_of(q, one);
    if (only != nullptr && own.name != only->name) continue;
    for (std::size_t k = 0; k < one.values.size(); ++k) {
      const QuantileBounds& value = one.values[k];
      std::vector<AnswerCell> row = {one.metric.name, only != nullptr ? "" : own.si,
                                     q.request.at[k], value.estimate};
      if (is_sample) append(row, {end_cell(value.low), end_cell(value.high)});
      append(row, {one.n, one.n_without, one.n_unresolved});
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

/// A table for each unit, in the order in which metrics have them.
void add_screen_tables(const Quantiles& q, Answer& answer) {
  std::vector<std::string> done;
  for (const MetricQuantiles& one : q.metrics) {
    const ShownUnit unit = unit_of(q, one);
    if (one.values.empty() || contains(done, unit.name)) continue;
    done.push_back(unit.name);
    AnswerTable table = table_of(q, &unit);
    table.in_files = false;
    answer.add(std::move(table));
  }
}

/// "F1.max_slip: the 5 % quantile is 0.01 m (0.008 to 0.012), the 95 % one 0.2 m (0.18 to open)."
std::string sentence_of(const Quantiles& q, const MetricQuantiles& one) {
  const ShownUnit unit = unit_of(q, one);
  if (one.values.empty()) return concat("No case has a ", one.metric.name, ".");
  const auto number = [&](double value) {
    return format_number(value / unit.size, kQuantileDigits);
  };
  const auto end = [&](const std::optional<double>& value) {
    return value ? number(*value) : std::string("open");
  };
  const bool is_sample = q.sampling.is_random;
  std::string text =
      one.metric.name +
      (is_sample ? ":" : concat(": of the ", one.n, " cases that were run and have a value"));
  for (std::size_t k = 0; k < one.values.size(); ++k) {
    const QuantileBounds& value = one.values[k];
    const std::string share = format_number(100 * q.request.at[k]) + " %";
    const std::string found = number(value.estimate) + (unit.name.empty() ? "" : " " + unit.name);
    text += concat(k == 0 ? " " : ", ",
                   is_sample ? concat("the ", share, k == 0 ? " quantile is " : " one ", found,
                                      " (", end(value.low), " to ", end(value.high), ")")
                             : concat(share, k == 0 ? " have at most " : " at most ", found));
  }
  return text + ".";
}

/// What the cells leave open of a metric, and its error; "" = nothing.
std::string open_note(const Quantiles& q, const MetricQuantiles& one) {
  const bool is_sample = q.sampling.is_random;
  std::string text;
  if (one.n_unresolved > 0)
    text = concat("In ", counted(one.n_unresolved, "case", "cases"), " the cells leave ",
                  one.metric.name, " undecided: ",
                  is_sample ? "the quantile takes them as computed, bounds allow for any value."
                            : "they are taken as computed.");
  if (one.error > 0 && is_sample)
    text += concat(text.empty() ? "" : " ", "Bounds of ", one.metric.name,
                   " are further away by its largest error, measured or stated by the tier, of ",
                   in_unit(one.error, unit_of(q, one), 2), ".");
  return text;
}

}  // namespace

Quantiles find_quantiles(const Store& store, const CampaignInfo& campaign,
                         const QuantileRequest& request) {
  for (const double q : request.at) {
    if (q > 0 && q < 1) continue;
    throw InputError("--at", concat(format_number(q), " is not a share of the cases"),
                     "write shares between 0 and 1: 0.05,0.5,0.95");
  }
  Quantiles found{campaign, request, sampling_of(store, campaign, {request.where}), 0, {}};
  const Selection selection = make_selection(store, campaign, "", "");
  const std::vector<ScopedMetric> metrics = choose_metrics(selection, request.metrics, true, false);
  const Store::Kinds kinds = kinds_of(store, campaign, selection, request.where);
  found.plane_strain = kinds.plane_strain;
  std::vector<ScopedMetric> columns = metrics;  // then whether they are resolved
  for (const ScopedMetric& one : metrics) {
    if (one.is_extensive()) refuse_mixed(kinds, "--quantiles", one.name);
    columns.push_back(unresolved_flag(one, selection));
  }
  const Sample sample = read_sample(store, campaign, {request.where, "", ""}, std::move(columns));
  found.n_unknown = sample.n_without + sample.n_early;
  const StatedErrors errors = stated_errors_of(store, campaign);
  for (std::size_t m = 0; m < metrics.size(); ++m) {
    const auto error = errors.find(metrics[m].metric);
    found.metrics.push_back(of_metric(metrics[m], sample.y[m], sample.y[metrics.size() + m],
                                      error == errors.end() ? 0 : error->second, found));
  }
  return found;
}

Answer to_answer(const Quantiles& q) {
  Answer answer;
  for (std::size_t k = 0; k < std::min(q.metrics.size(), kMostSentences); ++k)
    answer.headline.push_back(sentence_of(q, q.metrics[k]));
  answer.facts = {{"campaign", q.campaign.name},
                  {"confidence", q.request.confidence},
                  {"is_probability", q.sampling.is_random},
                  {"remark", q.sampling.remark},
                  {"unknown", q.n_unknown}};
  AnswerTable all = table_of(q, nullptr);
  all.on_screen = false;
  answer.add(std::move(all));
  add_screen_tables(q, answer);
  if (q.sampling.is_random) {
    answer.note(concat("Bounds contain each quantile with a confidence of ",
                       confidence_text(q.request.confidence),
                       ", whatever the distribution; open: too few cases."));
    if (q.n_unknown > 0)
      answer.note(concat(q.n_unknown, " cases without a full history may have any value."));
    answer.note_if(q.sampling.remark);
  } else {
    answer.note(
        "Order statistics of the cases run, not quantiles of a distribution: the cases were not "
        "drawn at random, so there are no bounds.");
    if (q.n_unknown > 0)
      answer.note(concat(q.n_unknown, " cases without a full history have no value here."));
  }
  for (const MetricQuantiles& one : q.metrics) {
    answer.note_if(open_note(q, one));
    if (one.n_without > 0)
      answer.note(concat(one.n_without, " full histories have no ", one.metric.name,
                         ": they are left out."));
  }
  answer.note_if(q.sampling.approximation);
  return answer;
}

}  // namespace faultsweep
