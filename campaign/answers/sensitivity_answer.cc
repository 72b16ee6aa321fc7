#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/answers/asked_outputs.h"
#include "campaign/answers/sensitivity.h"
#include "campaign/render/shown.h"

namespace faultsweep {

using faultsim::concat;
namespace figure = faultsim::figure;

namespace {

bool varies(const MetricSensitivity& metric) { return metric.standard_deviation > 0; }
bool is_told(const MetricSensitivity& metric) {
  return varies(metric) && !metric.first_order.empty();
}

std::string confidence_text(const Sensitivity& s) {
  return format_number(100 * s.request.confidence, 4) + " %";
}

/// Parameters of a metric, by index, largest first.
std::vector<std::size_t> largest_first(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  return order;
}

std::vector<double> values_of(const std::vector<Estimate>& estimates) {
  std::vector<double> values;
  for (const Estimate& one : estimates) values.push_back(one.value);
  return values;
}

/// "0.61 of its variance (0.58 to 0.64)".
std::string share_text(const Estimate& e) {
  constexpr int kDigits = 2;
  const std::string value = format_number(e.value, kDigits);
  if (!std::isfinite(half_width(e))) return value + " of its variance";
  return concat(value, " of its variance (", format_number(e.bounds.low, kDigits), " to ",
                format_number(e.bounds.high, kDigits), ")");
}

/// What matters most to a metric, and whether that is sure. @pre it varies with some parameter.
std::string sentence_of(const Sensitivity& s, const MetricSensitivity& metric) {
  const std::vector<std::size_t> order = largest_first(values_of(metric.first_order));
  const Estimate& most = metric.first_order[order[0]];
  const std::string &name = metric.metric.name, &first = s.parameters[order[0]];
  if (most.bounds.low <= 0) {
    return concat("No parameter surely explains any of ", name, " alone; most has ", first, ", ",
                  share_text(most), ".");
  }
  std::string text = concat(name, " depends most on ", first, ": ", share_text(most));
  if (order.size() > 1) {
    const Estimate& next = metric.first_order[order[1]];
    const bool is_told_apart = !(next.bounds.high >= most.bounds.low);
    text += concat(is_told_apart ? ", then on " : "; not told apart from ", s.parameters[order[1]],
                   ", ", format_number(next.value, 2));
  }
  return text + ".";
}

AnswerCell index_cell(const Estimate& e) { return {e.value, half_width(e)}; }

/// For a screen: a row for each metric that varies, parameters in the order in which they matter.
AnswerTable first_order_table(const Sensitivity& s) {
  std::vector<double> largest(s.parameters.size(), -1);
  for (const MetricSensitivity& one : s.metrics)
    for (std::size_t p = 0; varies(one) && p < one.first_order.size(); ++p)
      largest[p] = std::max(largest[p], one.first_order[p].value);
  const std::vector<std::size_t> order = largest_first(largest);
  AnswerTable table{"first_order",
                    "Share of a metric's variance that a parameter explains alone (first order)",
                    {{"metric", "metric", {}, 4, Need::always}}};
  constexpr int kDigits = 3;  // where there is no error
  for (const std::size_t p : order)
    table.columns.push_back({s.parameters[p], s.parameters[p], {}, kDigits});
  if (s.dependence.empty()) table.columns.push_back({"together", "together", {}, 2});
  table.columns.push_back({"rows", "rows", {}, 4});
  for (const MetricSensitivity& one : s.metrics) {
    if (!is_told(one)) continue;
    std::vector<AnswerCell> row = {one.metric.name};
    for (const std::size_t p : order) row.push_back(index_cell(one.first_order[p]));
    const std::vector<double> values = values_of(one.first_order);
    if (s.dependence.empty()) row.emplace_back(std::accumulate(values.begin(), values.end(), 0.0));
    row.emplace_back(one.n);
    table.rows.push_back(std::move(row));
  }
  table.in_files = false;
  return table;
}

/// "29 of 512".
std::string base_samples_of(const Sensitivity& s, const MetricSensitivity& metric) {
  return concat(metric.n_base_samples, " of ", s.n_base_samples);
}

/// For a screen: total indices of a sobol design, beside each of how many base samples.
AnswerTable total_order_table(const Sensitivity& s) {
  AnswerTable table{"total_order",
                    "Share in which a parameter takes part, interactions included (total order, by "
                    "pick-freeze)",
                    {{"metric", "metric", {}, 4, Need::always},
                     {"base_samples", "base samples", {}, 4, Need::always}}};
  for (const std::string& one : s.frozen) table.columns.push_back({one, one, {}, 3});
  bool any_left_out = false;
  for (const MetricSensitivity& one : s.metrics) {
    if (!varies(one) || one.sobol.empty()) continue;
    std::vector<AnswerCell> row = {one.metric.name, base_samples_of(s, one)};
    for (const SobolIndices& indices : one.sobol) row.push_back(index_cell(indices.total));
    table.rows.push_back(std::move(row));
    any_left_out = any_left_out || one.n_base_samples < s.n_base_samples;
  }
  if (any_left_out) {
    table.notes.emplace_back(
        "A base sample counts where each of its rows has a value. Where few of all do, the indices "
        "are of those few and of no others.");
  }
  table.in_files = false;
  return table;
}

/// For a screen: total indices of a whole grid.
AnswerTable grid_total_table(const Sensitivity& s) {
  AnswerTable table{"total_order",
                    "Share in which a parameter takes part, interactions included (total order)",
                    {{"metric", "metric", {}, 4, Need::always}}};
  constexpr int kDigits = 3;
  for (const std::string& one : s.parameters) table.columns.push_back({one, one, {}, kDigits});
  for (const MetricSensitivity& one : s.metrics) {
    if (!varies(one) || one.total_order.empty()) continue;
    std::vector<AnswerCell> row = {one.metric.name};
    for (const double total : one.total_order) row.emplace_back(total);
    table.rows.push_back(std::move(row));
  }
  table.in_files = false;
  return table;
}

/// The long form: all indices.
AnswerTable index_table(const Sensitivity& s) {
  AnswerTable table{"indices",
                    "",
                    {{"metric", "metric"},
                     {"parameter", "parameter"},
                     {"order", "order"},
                     {"method", "method"},
                     {"value", "share of variance"},
                     {"standard_error", "standard error"},
                     {"low", "from"},
                     {"high", "to"},
                     {"rows", "rows"},
                     {"base_samples", "base samples"}}};
  const auto add = [&](const MetricSensitivity& metric, const std::string& parameter,
                       const char* order, const char* method, const Estimate& e,
                       const AnswerCell& rows, const AnswerCell& base_samples) {
    table.rows.push_back({metric.metric.name, parameter, order, method, e.value, e.standard_error,
                          e.bounds.low, e.bounds.high, rows, base_samples});
  };
  const char* method = s.sampling.is_factorial ? "levels" : "ranks";
  for (const MetricSensitivity& one : s.metrics) {
    for (std::size_t p = 0; p < one.first_order.size(); ++p)
      add(one, s.parameters[p], "first", method, one.first_order[p], one.n, {});
    for (std::size_t p = 0; p < one.total_order.size(); ++p)
      add(one, s.parameters[p], "total", method,
          {one.total_order[p], kNoNumber, {kNoNumber, kNoNumber}}, one.n, {});
    for (std::size_t p = 0; p < one.sobol.size(); ++p) {
      add(one, s.frozen[p], "first", "pick-freeze", one.sobol[p].first, {}, one.n_base_samples);
      add(one, s.frozen[p], "total", "pick-freeze", one.sobol[p].total, {}, one.n_base_samples);
    }
  }
  table.on_screen = false;
  return table;
}

AnswerTable metric_table(const Sensitivity& s) {
  AnswerTable table{"metrics",
                    "",
                    {{"metric", "metric"},
                     {"unit", "unit"},
                     {"rows", "rows"},
                     {"mean", "mean"},
                     {"standard_deviation", "standard deviation"}}};
  for (const MetricSensitivity& one : s.metrics) {
    table.rows.push_back({one.metric.name, metric_unit(one.metric, s.plane_strain), one.n, one.mean,
                          one.standard_deviation});
  }
  table.on_screen = false;
  return table;
}

/// What the indices are, and what they are not.
void add_meaning(const Sensitivity& s, AnswerTable& table) {
  if (s.sampling.is_factorial) {
    table.notes.emplace_back(
        "Finite sums over the means of all cases that have a value of the parameter, each value as "
        "likely as the others: of what was run these shares are exact, and there are no intervals, "
        "as it is no random sample.");
  } else {
    table.notes.push_back(
        concat("By ranks; ± is half of the interval of ", confidence_text(s), "."));
  }
  table.notes.push_back(
      s.dependence.empty()
          ? "What `together` leaves to 1 is interaction."
          : concat(
                s.dependence,
                ": an index is the share that knowing the parameter alone would explain, shared "
                "with what it is correlated with. The indices do not add up, and what they leave "
                "to 1 is not interaction."));
}

/// "299 of 300 rows; left out: 1 without a result", and what counts although it is not sure.
std::string rows_text(const Sensitivity& s) {
  const Sample& sample = s.sample;
  std::string text =
      concat(sample.n_rows - sample.n_without - sample.n_early, " of ", sample.n_rows, " rows");
  std::string left_out;
  const auto leave = [&](long n, const char* why) {
    if (n > 0) left_out += concat(left_out.empty() ? "; left out: " : ", ", n, why);
  };
  leave(sample.n_without, " without a result");
  leave(sample.n_early, " that end early");
  text += left_out;
  if (s.sampling.is_factorial && !left_out.empty())
    text += ", so that the grid is not whole and the shares are of the rest";
  if (sample.n_unresolved > 0) {
    text += concat("; ", sample.n_unresolved,
                   " have an activation or event that the cells do not resolve, and count as "
                   "computed");
  }
  return text + ".";
}

/// Metrics of which there are too few rows, and indices that few rows make too low.
std::string minima_text(const Sensitivity& s) {
  std::string few, text;
  bool any_near_one = false;
  constexpr double kNearOne = 0.95;
  for (const MetricSensitivity& one : s.metrics) {
    if (!one.unsaid.empty()) few += (few.empty() ? "" : ", ") + one.unsaid;
    any_near_one =
        any_near_one || (!s.sampling.is_factorial && one.n < kFewestForRankIndexNearOne &&
                         std::any_of(one.first_order.begin(), one.first_order.end(),
                                     [](const Estimate& e) { return e.value > kNearOne; }));
  }
  if (!few.empty()) text = concat("Fewer rows than intervals take, so without indices: ", few, ".");
  if (any_near_one) {
    text += concat(text.empty() ? "" : " ", "Indices above ", kNearOne, " from fewer than ",
                   kFewestForRankIndexNearOne, " rows are some thousandths too low.");
  }
  return text;
}

figure::Bounded bounded(const Estimate& e) { return {e.value, e.bounds.low, e.bounds.high}; }

figure::BarChart::Block block_of(const Sensitivity& s, const MetricSensitivity& one) {
  figure::BarChart::Block block{one.metric.name, {}};
  const bool has_totals = !one.sobol.empty();
  const std::vector<std::string>& names = has_totals ? s.frozen : s.parameters;
  if (!has_totals && one.first_order.empty()) return block;
  std::vector<double> values;
  for (std::size_t p = 0; p < names.size(); ++p)
    values.push_back(has_totals ? one.sobol[p].total.value : one.first_order[p].value);
  for (const std::size_t p : largest_first(values)) {
    figure::BarRow row{names[p], bounded(has_totals ? one.sobol[p].first : one.first_order[p])};
    if (has_totals) row.second.push_back(bounded(one.sobol[p].total));
    block.rows.push_back(std::move(row));
  }
  return block;
}

}  // namespace

figure::BarChart chart_of(const Sensitivity& s) {
  figure::BarChart chart;
  chart.title = "What matters in " + s.campaign.name;
  chart.remark =
      concat("share of the variance that each parameter explains alone; ",
             s.sampling.is_factorial ? std::string("exact for the values of the grid")
                                     : concat("lines: ", confidence_text(s), " intervals"));
  chart.label = "share of variance";
  for (const MetricSensitivity& one : s.metrics) {
    figure::BarChart::Block block = block_of(s, one);
    if (!block.rows.empty()) chart.blocks.push_back(std::move(block));
    if (one.sobol.empty()) continue;
    chart.first_name = "alone";
    chart.second_name = "with all interactions";
  }
  return chart;
}

Answer to_answer(const Sensitivity& s) {
  Answer answer;
  std::string constant;
  for (const MetricSensitivity& one : s.metrics) {
    if (!varies(one)) {
      constant += concat(constant.empty() ? "" : ", ", one.metric.name);
    } else if (answer.headline.size() < kMostSentences && is_told(one)) {
      answer.headline.push_back(sentence_of(s, one));
    }
  }
  if (answer.headline.empty()) {
    answer.headline.emplace_back(
        std::any_of(s.metrics.begin(), s.metrics.end(),
                    [](const MetricSensitivity& one) { return varies(one); })
            ? "What varies has too few rows for indices."
            : "Nothing of this varies.");
  }
  answer.facts = {{"campaign", s.campaign.name},          {"kind", "shares"},
                  {"confidence", s.request.confidence},   {"is_sample", s.sampling.is_random},
                  {"dependence", s.dependence},           {"rows", s.sample.n_rows},
                  {"without_result", s.sample.n_without}, {"ends_early", s.sample.n_early},
                  {"unresolved", s.sample.n_unresolved},  {"base_samples", s.n_base_samples},
                  {"remark", s.sampling.remark}};
  answer.add(index_table(s));
  answer.add(metric_table(s));
  AnswerTable first = first_order_table(s);
  if (!first.rows.empty()) {
    add_meaning(s, first);
    answer.add(std::move(first));
  }
  for (AnswerTable total : {total_order_table(s), grid_total_table(s)})
    if (!total.rows.empty()) answer.add(std::move(total));
  answer.note_if(minima_text(s));
  if (!constant.empty()) answer.note(concat("The same in all cases: ", constant, "."));
  answer.blocks.emplace_back(AnswerChart(chart_of(s)));
  answer.note(rows_text(s));
  if (!s.sampling.is_factorial) answer.note_if(s.sampling.remark);
  return answer;
}

}  // namespace faultsweep
