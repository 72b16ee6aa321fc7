#include "campaign/answers/sensitivity_parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "campaign/answers/sample.h"
#include "campaign/common/names.h"
#include "campaign/render/shown.h"

namespace faultsweep {

bool is_varying(const MetricSensitivity& metric) { return metric.standard_deviation > 0; }
bool is_told(const MetricSensitivity& metric) {
  return is_varying(metric) && !metric.first_order.empty();
}

std::vector<std::size_t> descending_places(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  return order;
}

std::vector<double> values_of(const std::vector<Estimate>& estimates) {
  return mapped(estimates, &Estimate::value);
}

namespace {

/// "0.61 of its variance (0.58 to 0.64)".
std::string share_text(const Estimate& e) {
  constexpr int kDigits = 2;
  const std::string value = format_number(e.value, kDigits);
  if (!std::isfinite(half_width(e))) return value + " of its variance";
  return concat(value, " of its variance (", format_number(e.bounds.low, kDigits), " to ",
                format_number(e.bounds.high, kDigits), ")");
}

/// A metric of the tables for files.
struct Subject {
  const MetricSensitivity& values;
  std::string name;
  const Store::LoadStep* step = nullptr;  ///< nullptr = none, or all of them together.
};

std::vector<Subject> subjects_of(const Sensitivity& s) {
  std::vector<Subject> all;
  for (std::size_t m = 0; m < s.metrics.size(); ++m) {
    const MetricSensitivity& one = s.metrics[m];
    if (s.steps.empty()) {
      all.push_back({one, one.metric.name});
      continue;
    }
    const std::size_t k = m % s.steps.size();
    const MetricSensitivity& together = s.over_steps[m / s.steps.size()];
    all.push_back({one, together.metric.name, &s.steps[k]});
    if (k + 1 == s.steps.size()) all.push_back({together, together.metric.name});
  }
  return all;
}

/// The columns that say of what a row is.
std::vector<AnswerColumn> subject_columns(const Sensitivity& s) {
  std::vector<AnswerColumn> columns = {{"metric", "metric"}};
  if (!s.steps.empty()) {
    columns.push_back({"step", "step"});
    columns.push_back({"time_s", "time", shown_unit(Dimension::time)});
  }
  return columns;
}

std::vector<AnswerCell> subject_cells(const Sensitivity& s, const Subject& subject) {
  std::vector<AnswerCell> cells = {subject.name};
  if (s.steps.empty()) return cells;
  if (subject.step == nullptr) {
    cells.resize(3);
  } else {
    cells.emplace_back(subject.step->step);
    cells.emplace_back(subject.step->latest);
  }
  return cells;
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
    text += ", so the grid is incomplete and the shares are those of the rest";
  if (sample.n_unresolved > 0) {
    text += concat("; ", sample.n_unresolved,
                   " have an activation or event that the cells do not resolve, and count as "
                   "computed");
  }
  return text + ".";
}

}  // namespace

std::string sentence_of(const Sensitivity& s, const MetricSensitivity& metric) {
  const std::vector<std::size_t> order = descending_places(values_of(metric.first_order));
  const Estimate& most = metric.first_order[order[0]];
  const std::string &name = metric.metric.name, &first = s.parameters[order[0]];
  if (most.bounds.low <= 0) {
    return concat("No parameter certainly explains any of ", name,
                  " alone; the largest share is that of ", first, ", ", share_text(most), ".");
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

AnswerTable index_table(const Sensitivity& s) {
  AnswerTable table{"indices", "", subject_columns(s)};
  append(table.columns, {{"parameter", "parameter"},
                         {"order", "order"},
                         {"method", "method"},
                         {"value", "share of variance"},
                         {"standard_error", "standard error"},
                         {"low", "from"},
                         {"high", "to"},
                         {"rows", "rows"},
                         {"base_samples", "base samples"}});
  const auto add = [&](const Subject& subject, const std::string& parameter, const char* order,
                       const char* method, const Estimate& e, const AnswerCell& rows,
                       const AnswerCell& base_samples) {
    std::vector<AnswerCell> row = subject_cells(s, subject);
    append(row, {parameter, order, method, e.value, e.standard_error, e.bounds.low, e.bounds.high,
                 rows, base_samples});
    table.rows.push_back(std::move(row));
  };
  const char* method = s.sampling.is_factorial ? "levels" : "ranks";
  for (const Subject& subject : subjects_of(s)) {
    const MetricSensitivity& one = subject.values;
    for (std::size_t p = 0; p < one.first_order.size(); ++p)
      add(subject, s.parameters[p], "first", method, one.first_order[p], one.n, {});
    for (std::size_t p = 0; p < one.total_order.size(); ++p)
      add(subject, s.parameters[p], "total", method,
          {one.total_order[p], kNoNumber, {kNoNumber, kNoNumber}}, one.n, {});
    for (std::size_t p = 0; p < one.sobol.size(); ++p) {
      add(subject, s.frozen[p], "first", "pick-freeze", one.sobol[p].first, {}, one.n_base_samples);
      add(subject, s.frozen[p], "total", "pick-freeze", one.sobol[p].total, {}, one.n_base_samples);
    }
  }
  table.on_screen = false;
  return table;
}

AnswerTable metric_table(const Sensitivity& s) {
  AnswerTable table{"metrics", "", subject_columns(s)};
  append(table.columns, {{"unit", "unit"},
                         {"rows", "rows"},
                         {"mean", "mean"},
                         {"standard_deviation", "standard deviation"}});
  for (const Subject& subject : subjects_of(s)) {
    const MetricSensitivity& one = subject.values;
    std::vector<AnswerCell> row = subject_cells(s, subject);
    append(row, {metric_unit(one.metric, s.plane_strain), one.n, one.mean, one.standard_deviation});
    table.rows.push_back(std::move(row));
  }
  table.on_screen = false;
  return table;
}

std::vector<std::string> meaning_of(const Sensitivity& s) {
  std::vector<std::string> notes;
  if (s.sampling.is_factorial) {
    notes.emplace_back(
        "From the means over all cases with each value of the parameter, all values equally "
        "likely: for the cases run these shares are exact, and there are no intervals, as the "
        "cases are not a random sample.");
  } else {
    notes.push_back(concat("By ranks; ± is half of the interval of ",
                           confidence_text(s.request.confidence), "."));
  }
  notes.push_back(
      s.dependence.empty()
          ? "What remains of 1 beyond the shares of a row is interaction."
          : concat(
                s.dependence,
                ": an index is the share that knowing the parameter alone would explain, including "
                "that of parameters correlated with it. The indices do not add up, and what "
                "remains of 1 is not interaction."));
  return notes;
}

void add_what_they_stand_on(const Sensitivity& s, Answer& answer) {
  answer.note(rows_text(s));
  answer.note_if(derived_note(s.sample.derived));
  if (!s.sampling.is_factorial) answer.note_if(s.sampling.remark);
  answer.note_if(s.sampling.approximation);
}

nlohmann::ordered_json facts_of(const Sensitivity& s, const char* kind) {
  return {{"campaign", s.campaign.name},          {"kind", kind},
          {"confidence", s.request.confidence},   {"is_sample", s.sampling.is_random},
          {"dependence", s.dependence},           {"rows", s.sample.n_rows},
          {"without_result", s.sample.n_without}, {"ends_early", s.sample.n_early},
          {"unresolved", s.sample.n_unresolved},  {"base_samples", s.n_base_samples},
          {"remark", s.sampling.remark}};
}

}  // namespace faultsweep
