#include "campaign/answers/quantiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

/// The smallest of the values that no less than the share q of them do not exceed.
double order_statistic(const std::vector<double>& sorted, double q) {
  constexpr double kRounding = 1e-9;  // 0.05 of 20 is the first
  const double place = std::ceil(q * static_cast<double>(sorted.size()) - kRounding);
  return sorted[static_cast<std::size_t>(std::max(1.0, place)) - 1];
}

MetricQuantiles of_metric(const ScopedMetric& metric, std::vector<double> values,
                          const Quantiles& all) {
  MetricQuantiles found{metric, 0, 0, {}};
  const auto n_all = values.size();
  std::erase_if(values, [](double one) { return !std::isfinite(one); });
  found.n = static_cast<long>(values.size());
  found.n_without = static_cast<long>(n_all - values.size());
  if (values.empty()) return found;
  std::ranges::sort(values);
  for (const double q : all.request.at) {
    if (all.sampling.is_random) {
      found.values.push_back(quantile_bounds(values, all.n_unknown, q, all.request.confidence));
    } else {
      found.values.push_back({order_statistic(values, q), std::nullopt, std::nullopt});
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
  for (const MetricQuantiles& one : q.metrics) {
    const ShownUnit own = unit_of(q, one);
    if (only != nullptr && own.name != only->name) continue;
    for (std::size_t k = 0; k < one.values.size(); ++k) {
      const QuantileBounds& value = one.values[k];
      std::vector<AnswerCell> row = {one.metric.name, only != nullptr ? "" : own.si,
                                     q.request.at[k], value.estimate};
      if (is_sample) append(row, {end_cell(value.low), end_cell(value.high)});
      append(row, {one.n, one.n_without});
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

}  // namespace

Quantiles find_quantiles(const Store& store, const CampaignInfo& campaign,
                         const QuantileRequest& request) {
  for (const double q : request.at) {
    if (q > 0 && q < 1) continue;
    throw InputError("--at", concat(format_number(q), " is not a share of the cases"),
                     "write shares between 0 and 1: 0.05,0.5,0.95");
  }
  Quantiles found{campaign, request, sampling_of(store, campaign), 0, {}};
  Sample sample = read_sample(store, campaign, {request.where, "", ""}, request.metrics);
  found.n_unknown = sample.n_without + sample.n_early;
  const Store::Kinds kinds = store.kinds(campaign.id, {});
  found.plane_strain = kinds.plane_strain;
  for (std::size_t m = 0; m < sample.outputs.size(); ++m) {
    const ScopedMetric& metric = sample.outputs[m];
    if (metric.is_extensive()) refuse_mixed(kinds, "--quantiles", metric.name);
    found.metrics.push_back(of_metric(metric, std::move(sample.y[m]), found));
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
    if (one.n_without > 0)
      answer.note(concat(one.n_without, " full histories have no ", one.metric.name,
                         ": they are left out."));
  }
  answer.note_if(q.sampling.approximation);
  return answer;
}

}  // namespace faultsweep
