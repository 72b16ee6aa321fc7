#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/render/shown.h"
#include "campaign/reports/compare.h"

namespace faultsweep {

namespace {

/// "m2", or "m2/m" of plane strain; "m2 or m2/m" where pairs of both kinds were compared.
std::string unit_of(const MetricInfo& metric, const Comparison& c) {
  const std::string unit = metric_unit(metric, c.kinds.plane_strain);
  return c.kinds.mixed() && metric.is_extensive() ? concat(metric_unit(metric, false), " or ", unit)
                                                  : unit;
}

std::string matched_note(const Comparison& c) {
  std::string by = joined(c.shared_parameters, ", ");
  std::string text =
      concat("A ", c.a.name, ", ", c.a.n_cases, " cases; B ", c.b.name, ", ", c.b.n_cases,
             " cases; matched: ", c.n_by_identity, " by identity, ", c.n_by_parameters,
             " by the parameters that both have (", by.empty() ? "none" : by,
             "); only in A: ", c.n_only_a, ", only in B: ", c.n_only_b);
  if (c.n_ambiguous > 0) {
    text += concat("; ", c.n_ambiguous,
                   " are not matched, because other cases have the same values of these");
  }
  if (c.n_same_result > 0) {
    text += concat("; ", c.n_same_result,
                   " share one stored result: they are the same case, with nothing to compare");
  }
  if (c.n_without > 0) text += concat("; ", c.n_without, " have no result in A or in B yet");
  return text;
}

std::vector<std::string> headline_of(const Comparison& c) {
  const std::string names = concat("A ", c.a.name, " and B ", c.b.name);
  if (c.pairs.empty()) return {concat("COMPARED NOTHING of ", names, ".")};
  const std::string tolerance = concat("the tolerance of ", format_number(c.request.tolerance));
  const std::string cases = counted(c.pairs.size(), "case", "cases");
  std::vector<std::string> sentences;
  if (c.agrees()) {
    sentences.push_back(concat(names, " agree within ", tolerance, " in all ", cases, " compared; ",
                               c.count(&ComparedPair::identical),
                               " are identical bit for bit in outcome and all metrics."));
  } else {
    sentences.push_back(concat(names, " differ beyond ", tolerance, " in ", c.n_beyond(), " of ",
                               cases, " compared: ", c.count(&ComparedPair::outcome_differs),
                               " have different outcomes, ", c.count(&ComparedPair::flipped),
                               " slide in one only; ", c.count(&ComparedPair::identical),
                               " are identical bit for bit in outcome and all metrics."));
  }
  if (c.n_ranked > 1) {
    sentences.push_back(concat("Ranking of ", c.n_ranked, " full histories: Kendall's τ-b ",
                               c.tau_b ? format_number(*c.tau_b) : "none (all tied)", "; ",
                               c.n_top_shared, " of the ", c.n_top, " highest of A are among the ",
                               c.n_top, " highest of B."));
  }
  return sentences;
}

AnswerTable metrics_table(const Comparison& c) {
  AnswerTable table{"metrics",
                    "",
                    {{"name", "metric", {}, 4, Need::always},
                     {"unit", "unit", {}, 4, Need::always},
                     {"compared", "compared", {}, 4, Need::wanted},
                     {"beyond_tolerance", "beyond", {}, 4, Need::always},
                     {"in_one_only", "in one only", {}, 4, Need::wanted},
                     {"max_absolute", "max difference", {}, 4, Need::always},
                     {"max_relative", "max relative", {}, 3, Need::always},
                     {"case_a", "case A", {}, 4, Need::wanted},
                     {"case_b", "case B", {}, 4, Need::wanted}}};
  for (const MetricDifference& m : c.metrics) {
    if (m.n_compared + m.n_one_missing == 0) continue;
    table.rows.push_back({m.metric.name, unit_of(m.metric, c), m.n_compared, m.n_beyond,
                          m.n_one_missing, m.max_absolute, m.max_relative, case_cell(m.worst_a),
                          case_cell(m.worst_b)});
  }
  return table;
}

/// How many pairs the table of the worst shows: those that differ at all.
std::size_t n_shown(const Comparison& c) {
  const auto differ =
      std::ranges::count_if(c.pairs, [](const ComparedPair& p) { return !p.identical; });
  return static_cast<std::size_t>(c.request.top > 0 ? std::min<long>(c.request.top, differ)
                                                    : differ);
}

AnswerTable worst_table(const Comparison& c) {
  std::vector<const CaseParameters*> rows;
  for (std::size_t k = 0; k < n_shown(c); ++k) rows.push_back(&c.pairs[k].parameters);
  const ParameterColumns parameters(c.a.parameters, rows);
  AnswerTable table{"worst",
                    rows.empty() ? "" : "the worst:",
                    {{"case_a", "case A", {}, 4, Need::always},
                     {"case_b", "case B", {}, 4, Need::always},
                     {"outcome_a", "outcome A", {}, 4, Need::wanted},
                     {"outcome_b", "outcome B", {}, 4, Need::wanted},
                     {"activated_in_one_only", "slides in one only", {}, 4, Need::wanted},
                     {"metric", "worst metric", {}, 4, Need::always, "worst"},
                     {"unit", "unit", {}, 4, Need::always, "worst"},
                     {"a", "A", {}, 6, Need::always, "worst"},
                     {"b", "B", {}, 6, Need::always, "worst"},
                     {"relative", "relative", {}, 3, Need::always, "worst"}}};
  table.columns.insert(table.columns.begin() + 2, parameters.columns().begin(),
                       parameters.columns().end());
  for (std::size_t k = 0; k < n_shown(c); ++k) {
    const ComparedPair& p = c.pairs[k];
    std::vector<AnswerCell> cells = {p.a, p.b};
    parameters.add_cells(p.parameters, cells);
    append(cells, {p.outcome_a, p.outcome_b, p.flipped});
    if (p.worst > 0) {
      const MetricInfo& metric = c.metrics[p.worst_metric].metric;
      append(cells, {metric.name, unit_of(metric, c), p.worst_a, p.worst_b, p.worst});
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

nlohmann::ordered_json facts_of(const Comparison& c) {
  return {{"a", c.a.name},
          {"b", c.b.name},
          {"stage", c.request.stage},
          {"tolerance", c.request.tolerance},
          {"agrees", c.agrees()},
          {"matched_by_identity", c.n_by_identity},
          {"matched_by_parameters", c.n_by_parameters},
          {"shared_parameters", c.shared_parameters},
          {"only_a", c.n_only_a},
          {"only_b", c.n_only_b},
          {"ambiguous", c.n_ambiguous},
          {"same_result", c.n_same_result},
          {"without_result", c.n_without},
          {"compared", c.pairs.size()},
          {"identical", c.count(&ComparedPair::identical)},
          {"beyond_tolerance", c.n_beyond()},
          {"other_outcome", c.count(&ComparedPair::outcome_differs)},
          {"activated_in_one_only", c.count(&ComparedPair::flipped)},
          {"ranked", c.n_ranked},
          {"kendall_tau_b", c.tau_b ? json(*c.tau_b) : json()},
          {"top", c.n_top},
          {"top_shared", c.n_top_shared}};
}

}  // namespace

Answer to_answer(const Comparison& c) {
  Answer answer{headline_of(c)};
  answer.facts = facts_of(c);
  answer.note(matched_note(c));
  answer.add(metrics_table(c));
  answer.add(worst_table(c));
  return answer;
}

}  // namespace faultsweep
