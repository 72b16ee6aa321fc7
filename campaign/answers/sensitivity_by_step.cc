#include <algorithm>
#include <cmath>

#include "campaign/answers/sensitivity_parts.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace figure = faultsim::figure;

namespace {

/// The m-th metric at the k-th load step.
const MetricSensitivity& at_step(const Sensitivity& s, std::size_t m, std::size_t k) {
  return s.metrics[m * s.steps.size() + k];
}

/// Times of steps on screens and charts: days for histories of less than two years.
ShownUnit time_unit(const Sensitivity& s) {
  constexpr double kDay = 86400;
  if (s.steps.back().latest < 2 * kYear) return {"days", kDay, "s"};
  return {"years", kYear, "s"};
}

/// Whether all cases reach each step at the same time.
bool have_same_times(const Sensitivity& s) {
  return std::ranges::all_of(s.steps, [](const Store::LoadStep& one) {
    return one.latest - one.earliest <= 1e-9 * one.latest;
  });
}

std::string with_blanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// " At first friction explains most, from step 11 (cushion gas injection) on recovery.": how the
/// parameter with the largest share changes; "" where it is one and the same.
std::string changes_of(const Sensitivity& s, std::size_t m) {
  std::string text;
  std::size_t n_changes = 0;
  const std::string* leading = nullptr;
  for (std::size_t k = 0; k < s.steps.size(); ++k) {
    const MetricSensitivity& one = at_step(s, m, k);
    if (!is_told(one)) continue;
    const std::string& first = s.parameters[descending_places(values_of(one.first_order)).front()];
    if (leading == nullptr) {
      text = concat(" At first ", first, " explains most");
    } else if (first != *leading) {
      ++n_changes;
      text += concat(", from step ", s.steps[k].step, " (", with_blanks(s.steps[k].stage), ") on ",
                     first);
    }
    leading = &first;
  }
  constexpr std::size_t kMostChanges = 3;
  if (n_changes == 0) return "";
  if (n_changes > kMostChanges)
    return concat(" Which parameter explains most changes ", n_changes, " times.");
  return text + ".";
}

/// A row for each step, then one of all together.
AnswerTable step_table(const Sensitivity& s, std::size_t m) {
  const MetricSensitivity& together = s.over_steps[m];
  const ShownUnit unit = unit_of(together.metric, s.plane_strain);
  AnswerTable table{"by_step",
                    concat("Share of the variance of ", together.metric.name,
                           " that a parameter explains alone, at the end of each load step"),
                    {{"step", "step", {}, 4, Need::always},
                     {"stage", "stage"},
                     {"time_s", "time", time_unit(s)},
                     {"mean", "mean", unit, kShareDigits, Need::extra},
                     {"deviation", "spread", unit, kShareDigits, Need::extra}}};
  std::vector<std::size_t> order = descending_places(values_of(together.first_order));
  if (order.empty()) order = descending_places(std::vector<double>(s.parameters.size()));
  constexpr std::size_t kAlways = 3;  // the others where the screen is wide enough
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::string& name = s.parameters[order[k]];
    table.columns.push_back(
        {name, name, {}, kShareDigits, k < kAlways ? Need::always : Need::wanted});
  }
  const auto add = [&](std::vector<AnswerCell> row, const MetricSensitivity& one) {
    row.emplace_back(one.mean);
    row.emplace_back(one.standard_deviation);
    for (std::size_t k = 0; is_told(one) && k < order.size(); ++k)
      row.push_back(index_cell(one.first_order[order[k]]));
    table.rows.push_back(std::move(row));
  };
  const bool has_times = have_same_times(s);
  for (std::size_t k = 0; k < s.steps.size(); ++k) {
    add({std::to_string(s.steps[k].step), with_blanks(s.steps[k].stage),
         has_times ? AnswerCell(s.steps[k].latest) : AnswerCell()},
        at_step(s, m, k));
  }
  add({"all", AnswerCell(), AnswerCell()}, together);
  table.notes.emplace_back(
      "all: the steps together, each weighted by its variance. Spread is the standard "
      "deviation, for all steps the root of their mean variance. Steps without shares do not vary, "
      "or have too few rows for intervals.");
  if (!has_times)
    table.notes.emplace_back(
        "Cases reach the steps at different times: they are compared by step.");
  table.in_files = false;
  return table;
}

std::vector<figure::StageSpan> stage_spans(const Sensitivity& s,
                                           const std::vector<double>& places) {
  std::vector<figure::StageSpan> spans;
  for (std::size_t k = 1; k < s.steps.size(); ++k) {
    const std::string name = with_blanks(s.steps[k].stage);
    if (spans.empty() || spans.back().name != name) spans.push_back({name, places[k - 1], 0});
    spans.back().to = places[k];
  }
  return spans;
}

/// Whether a parameter surely explains some of a metric at some step; of a grid: a hundredth.
bool ever_matters(const Sensitivity& s, std::size_t m, std::size_t p) {
  constexpr double kNothing = 0.01;
  for (std::size_t k = 0; k < s.steps.size(); ++k) {
    const MetricSensitivity& one = at_step(s, m, k);
    if (!is_told(one)) continue;
    const Estimate& e = one.first_order[p];
    if (std::isnan(e.bounds.low) ? e.value > kNothing : e.bounds.low > 0) return true;
  }
  return false;
}

/// First-order shares against time, a panel for each metric; against steps where times differ.
figure::HistoryChart history_of(const Sensitivity& s) {
  const ShownUnit unit = time_unit(s);
  const bool has_times = have_same_times(s);
  figure::HistoryChart chart;
  chart.title = "What matters when in " + s.campaign.name;
  chart.remark = concat("share of the variance that each parameter explains alone; ",
                        s.sampling.is_factorial ? "those below 0.01 throughout are left out"
                                                : "those not certain at any step are left out");
  chart.time_label = has_times ? "time, " + unit.name : "load step";
  for (const Store::LoadStep& one : s.steps)
    chart.time.push_back(has_times ? one.latest / unit.size : one.step);
  chart.stages = stage_spans(s, chart.time);
  for (std::size_t m = 0; m < s.over_steps.size(); ++m) {
    if (!is_varying(s.over_steps[m])) continue;
    figure::HistoryPanel panel{s.over_steps[m].metric.name + ", share", {}, {}, {0, 1}};
    for (std::size_t p = 0; p < s.parameters.size(); ++p) {
      if (!ever_matters(s, m, p)) continue;
      figure::Curve curve{s.parameters[p], p, {}};
      for (std::size_t k = 0; k < s.steps.size(); ++k) {
        const MetricSensitivity& one = at_step(s, m, k);
        curve.values.push_back(is_told(one) ? std::max(one.first_order[p].value, 0.0) : kNoNumber);
      }
      panel.curves.push_back(std::move(curve));
    }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

}  // namespace

Answer answer_by_step(const Sensitivity& s) {
  Answer answer;
  std::string constant;
  answer.add(index_table(s));
  answer.add(metric_table(s));
  bool any_varies = false;
  for (std::size_t m = 0; m < s.over_steps.size(); ++m) {
    const MetricSensitivity& together = s.over_steps[m];
    if (!is_varying(together)) {
      constant += concat(constant.empty() ? "" : ", ", together.metric.name);
      continue;
    }
    any_varies = true;
    if (is_told(together) && answer.headline.size() < kMostSentences)
      answer.headline.push_back(
          concat("Over all load steps ", sentence_of(s, together), changes_of(s, m)));
    answer.add(step_table(s, m));
  }
  if (any_varies) answer.blocks.emplace_back(AnswerChart(history_of(s)));
  if (answer.headline.empty()) {
    answer.headline.emplace_back(any_varies ? "The metrics that vary have too few rows for indices."
                                            : "None of these metrics varies.");
  }
  answer.facts = facts_of(s, "shares-by-step");
  for (const std::string& one : meaning_of(s)) answer.note(one);
  if (!constant.empty())
    answer.note(concat("The same in all cases at every step: ", constant, "."));
  add_what_they_stand_on(s, answer);
  return answer;
}

}  // namespace faultsweep
