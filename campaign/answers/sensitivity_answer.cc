#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/answers/sensitivity_parts.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace figure = faultsim::figure;

namespace {

/// For a screen: a row for each metric that varies, parameters in the order in which they matter.
AnswerTable first_order_table(const Sensitivity& s) {
  std::vector<double> largest(s.parameters.size(), -1);
  for (const MetricSensitivity& one : s.metrics)
    for (std::size_t p = 0; is_varying(one) && p < one.first_order.size(); ++p)
      largest[p] = std::max(largest[p], one.first_order[p].value);
  const std::vector<std::size_t> order = descending_places(largest);
  AnswerTable table{"first_order",
                    "Share of a metric's variance that a parameter explains alone (first order)",
                    {{"metric", "metric", {}, 4, Need::always}}};
  for (const std::size_t p : order)
    table.columns.push_back({s.parameters[p], s.parameters[p], {}, kShareDigits});
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

/// For a screen: total indices, of a sobol design beside each of how many base samples.
AnswerTable total_order_table(const Sensitivity& s) {
  const bool is_grid = s.sampling.is_factorial;
  AnswerTable table{"total_order",
                    concat("Share in which a parameter takes part, interactions included (total "
                           "order",
                           is_grid ? ")" : ", by pick-freeze)"),
                    {{"metric", "metric", {}, 4, Need::always}}};
  if (!is_grid) table.columns.push_back({"base_samples", "base samples", {}, 4, Need::always});
  for (const std::string& one : is_grid ? s.parameters : s.frozen)
    table.columns.push_back({one, one, {}, kShareDigits});
  bool any_left_out = false;
  for (const MetricSensitivity& one : s.metrics) {
    if (!is_varying(one) || (one.sobol.empty() && one.total_order.empty())) continue;
    std::vector<AnswerCell> row = {one.metric.name};
    if (!is_grid) row.emplace_back(concat(one.n_base_samples, " of ", s.n_base_samples));
    for (const SobolIndices& indices : one.sobol) row.push_back(index_cell(indices.total));
    append(row, {one.total_order.begin(), one.total_order.end()});
    table.rows.push_back(std::move(row));
    any_left_out = any_left_out || one.n_base_samples < s.n_base_samples;
  }
  if (any_left_out) {
    table.notes.emplace_back(
        "A base sample counts if each of its rows has a value. If few do, the indices are those of "
        "these few only.");
  }
  table.in_files = false;
  return table;
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
                         std::ranges::any_of(one.first_order,
                                             [](const Estimate& e) { return e.value > kNearOne; }));
  }
  if (!few.empty()) text = concat("Without indices, as intervals need more rows: ", few, ".");
  if (any_near_one) {
    text += concat(text.empty() ? "" : " ", "Indices above ", kNearOne, " from fewer than ",
                   kFewestForRankIndexNearOne, " rows are a few thousandths too low.");
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
  for (const std::size_t p : descending_places(values)) {
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
             s.sampling.is_factorial
                 ? std::string("exact for the values of the grid")
                 : concat("lines: ", confidence_text(s.request.confidence), " intervals"));
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
  if (s.request.by_step) return answer_by_step(s);
  Answer answer;
  std::string constant;
  for (const MetricSensitivity& one : s.metrics) {
    if (!is_varying(one)) {
      constant += concat(constant.empty() ? "" : ", ", one.metric.name);
    } else if (answer.headline.size() < kMostSentences && is_told(one)) {
      answer.headline.push_back(sentence_of(s, one));
    }
  }
  if (answer.headline.empty()) {
    answer.headline.emplace_back(
        std::ranges::any_of(s.metrics, [](const MetricSensitivity& one) { return is_varying(one); })
            ? "The metrics that vary have too few rows for indices."
            : "None of these metrics varies.");
  }
  answer.facts = facts_of(s, "shares");
  answer.add(index_table(s));
  answer.add(metric_table(s));
  AnswerTable first = first_order_table(s);
  if (!first.rows.empty()) {
    first.notes = meaning_of(s);
    answer.add(std::move(first));
  }
  AnswerTable total = total_order_table(s);
  if (!total.rows.empty()) answer.add(std::move(total));
  answer.note_if(minima_text(s));
  if (!constant.empty()) answer.note(concat("The same in all cases: ", constant, "."));
  answer.blocks.emplace_back(AnswerChart(chart_of(s)));
  add_what_they_stand_on(s, answer);
  return answer;
}

}  // namespace faultsweep
