#include "campaign/answers/screening.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/answers/sample.h"
#include "campaign/answers/sensitivity_parts.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace figure = faultsim::figure;

namespace {

void forget_bounds(Estimate& e) { e.standard_error = kNoNumber, e.bounds = {kNoNumber, kNoNumber}; }

/// Intervals that would not hold are not told.
void keep_what_holds(ElementaryEffects& one) {
  if (one.n < kFewestTrajectories) forget_bounds(one.mean), forget_bounds(one.mean_magnitude);
  if (one.n < kFewestForDeviation) forget_bounds(one.deviation);
}

bool varies(const MetricEffects& metric) {
  return std::ranges::any_of(
      metric.effects, [](const ElementaryEffects& one) { return one.mean_magnitude.value > 0; });
}

/// Parameters, the one with the largest μ* first; those of which nothing is known last.
std::vector<std::size_t> largest_first(const MetricEffects& metric) {
  std::vector<double> magnitudes;
  for (const ElementaryEffects& one : metric.effects) {
    const double value = one.mean_magnitude.value;
    magnitudes.push_back(std::isnan(value) ? -1 : value);
  }
  return descending_places(magnitudes);
}

/// "F1.chi_bar changes most with offset: by 0.31 on average over its range (μ*), ..."
std::string sentence_of(const Screening& s, const MetricEffects& metric) {
  constexpr int kDigits = 2;
  const ShownUnit unit = unit_of(metric.metric, s.plane_strain);
  const std::vector<std::size_t> order = largest_first(metric);
  const ElementaryEffects& most = metric.effects[order[0]];
  std::string text =
      concat(metric.metric.name, " changes most with ", s.parameters[order[0]], ": by ",
             in_unit(most.mean_magnitude.value, unit, kDigits), " over its whole range on average");
  if (std::isfinite(most.mean_magnitude.bounds.low)) {
    text += concat(" (", format_number(most.mean_magnitude.bounds.low / unit.size, kDigits), " to ",
                   format_number(most.mean_magnitude.bounds.high / unit.size, kDigits), ")");
  }
  if (order.size() > 1) {
    const ElementaryEffects& next = metric.effects[order[1]];
    text += concat("; then with ", s.parameters[order[1]], ", ",
                   in_unit(next.mean_magnitude.value, unit, kDigits));
  }
  return text + ".";
}

AnswerTable table_of(const Screening& s, const MetricEffects* only) {
  const ShownUnit unit = only != nullptr ? unit_of(only->metric, s.plane_strain) : plain();
  constexpr int kDigits = 3;
  AnswerTable table{"effects",
                    only != nullptr ? only->metric.name : "",
                    {{"metric", "metric", {}, 4, Need::data},
                     {"unit", "unit", {}, 4, Need::data},
                     {"parameter", "parameter", {}, 4, Need::always},
                     {"mean_magnitude", "μ*", unit, kDigits, Need::always},
                     {"deviation", "σ", unit, kDigits, Need::always},
                     {"mean", "μ", unit, kDigits},
                     {"effects", "effects"}}};
  for (const MetricEffects& metric : s.metrics) {
    if (only != nullptr && &metric != only) continue;
    for (const std::size_t p : largest_first(metric)) {
      const ElementaryEffects& one = metric.effects[p];
      table.rows.push_back({metric.metric.name, unit_of(metric.metric, s.plane_strain).si,
                            s.parameters[p], index_cell(one.mean_magnitude),
                            index_cell(one.deviation), index_cell(one.mean), one.n});
    }
  }
  table.on_screen = only != nullptr;
  table.in_files = only == nullptr;
  return table;
}

figure::BarChart chart_of(const Screening& s, const MetricEffects& metric) {
  const ShownUnit unit = unit_of(metric.metric, s.plane_strain);
  const auto shown = [&](const Estimate& e) {
    return figure::Bounded{e.value / unit.size, e.bounds.low / unit.size,
                           e.bounds.high / unit.size};
  };
  figure::BarChart chart;
  chart.title = concat("What changes ", metric.metric.name, " in ", s.campaign.name);
  chart.remark = concat(s.n_trajectories, " trajectories; per whole range of a parameter");
  chart.label = unit.name.empty() ? "effect" : "effect, " + unit.name;
  chart.first_name = "μ*, how much";
  chart.second_name = "σ, how unevenly";
  chart.always = {0};
  figure::BarChart::Block block{metric.metric.name, {}};
  for (const std::size_t p : largest_first(metric)) {
    const ElementaryEffects& one = metric.effects[p];
    if (one.n > 0)
      block.rows.push_back({s.parameters[p], shown(one.mean_magnitude), {shown(one.deviation)}});
  }
  chart.blocks.push_back(std::move(block));
  return chart;
}

/// What the numbers are, and of how many rows.
void add_notes(const Screening& s, Answer& answer) {
  answer.note(
      "Elementary effects (Morris 1991): the change of the metric as one parameter moves, scaled "
      "to its whole range. μ* is the mean of their magnitudes, μ that of their signed values; σ, "
      "their standard deviation, is large if the effect depends on other parameters or on the "
      "parameter's own value.");
  if (s.n_trajectories < kFewestForDeviation) {
    answer.note(concat(
        s.n_trajectories, " trajectories: intervals of ",
        s.n_trajectories < kFewestTrajectories ? "μ* and μ" : "σ", " need at least ",
        s.n_trajectories < kFewestTrajectories ? kFewestTrajectories : kFewestForDeviation,
        " and are left out",
        s.n_trajectories < kFewestTrajectories ? concat(", those of σ need ", kFewestForDeviation)
                                               : std::string(),
        "."));
  }
  std::string rows = concat(s.n_rows - s.n_without, " of ", s.n_rows, " rows");
  if (s.n_without > 0)
    rows += "; each without a full history removes the effects before and after it";
  if (s.n_unresolved > 0) {
    rows += concat("; ", s.n_unresolved,
                   " have an activation or event that the cells do not resolve, and count as "
                   "computed");
  }
  answer.note(rows + ".");
  answer.note_if(derived_note(s.derived));
}

}  // namespace

std::optional<Screening> screen(const Store& store, const CampaignInfo& campaign,
                                const SensitivityRequest& request) {
  const std::vector<nlohmann::json> designs = designs_of(store, campaign);
  if (designs.size() != 1 || designs[0].at("kind") != "morris") return std::nullopt;
  if (!request.cases.where.empty() || campaign.n_excluded > 0) {
    throw InputError("sensitivity", "selecting cases of a morris design breaks its trajectories",
                     request.cases.where.empty()
                         ? "give the spec ranges from which nothing is excluded"
                         : "leave out --where");
  }
  const Selection selection =
      make_selection(store, campaign, request.cases.stage, request.cases.fault);
  Sample rows =
      read_design(store, campaign, selection, asked_outputs(store, campaign, request, selection));
  Screening s{campaign, request, {}, {}, rows.derived};
  s.plane_strain = kinds_of(store, campaign, selection, request.cases.where).plane_strain;
  s.n_rows = rows.n_rows;
  s.n_without = rows.n_without + rows.n_early;
  s.n_unresolved = rows.n_unresolved;
  for (const StoredParameter& one : rows.parameters) s.parameters.push_back(one.name);
  for (const ScopedMetric& one : rows.outputs) s.metrics.push_back({one, {}});
  const double p = designs[0].value("levels", 4);
  const auto made = MorrisDesign::make(rows.x, p / (2 * (p - 1)));
  if (!made.design)
    throw InputError("sensitivity", made.refusal, "submit the campaign's spec again as it was");
  s.n_trajectories = made.design->n_trajectories();
  for (std::size_t m = 0; m < rows.y.size(); ++m) {
    flatten_rounding(rows.outputs[m], rows.y[m]);
    s.metrics[m].effects = made.design->effects(rows.y[m], request.confidence);
    for (ElementaryEffects& one : s.metrics[m].effects) keep_what_holds(one);
  }
  return s;
}

Answer to_answer(const Screening& s) {
  Answer answer;
  std::string constant;
  for (const MetricEffects& one : s.metrics) {
    if (!varies(one)) {
      constant += (constant.empty() ? "" : ", ") + one.metric.name;
    } else if (answer.headline.size() < kMostSentences) {
      answer.headline.push_back(sentence_of(s, one));
    }
  }
  if (answer.headline.empty())
    answer.headline.emplace_back("No parameter changes any of these metrics.");
  answer.facts = {
      {"campaign", s.campaign.name},      {"kind", "effects"}, {"confidence", s.request.confidence},
      {"trajectories", s.n_trajectories}, {"rows", s.n_rows},  {"without_result", s.n_without},
      {"unresolved", s.n_unresolved}};
  answer.add(table_of(s, nullptr));
  for (const MetricEffects& one : s.metrics)
    if (varies(one)) answer.add(table_of(s, &one));
  for (const MetricEffects& one : s.metrics)
    if (varies(one)) answer.blocks.emplace_back(AnswerChart(chart_of(s, one)));
  if (!constant.empty()) answer.note(concat("Changed by nothing: ", constant, "."));
  add_notes(s, answer);
  return answer;
}

}  // namespace faultsweep
