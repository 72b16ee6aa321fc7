#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/report/compare.h"
#include "campaign/report/parameters.h"
#include "campaign/report/text_table.h"

namespace faultsweep {

using faultsim::concat;
using nlohmann::json;

namespace {

/// "m2", or "m2/m" of plane strain; "m2 or m2/m" where pairs of both kinds were compared.
std::string unit_of(const MetricInfo& metric, const Comparison& c) {
  const std::string unit = metric_unit(metric, c.kinds.plane_strain);
  return c.kinds.mixed() && metric.is_extensive() ? concat(metric_unit(metric, false), " or ", unit)
                                                  : unit;
}

/// "chi_bar" or "moment/(N m)".
std::string name_with_unit(const MetricInfo& metric, const Comparison& c) {
  const std::string unit = unit_of(metric, c);
  if (unit.empty()) return metric.name;
  const bool one_word = unit.find_first_of(" /") == std::string::npos;
  return one_word ? concat(metric.name, "/", unit) : concat(metric.name, "/(", unit, ")");
}

std::string matched_text(const Comparison& c) {
  std::string by;
  for (const std::string& name : c.shared_parameters) by += (by.empty() ? "" : ", ") + name;
  std::string text =
      concat("A ", c.a.name, ", ", c.a.n_cases, " cases; B ", c.b.name, ", ", c.b.n_cases,
             " cases\nmatched: ", c.n_by_identity, " by identity, ", c.n_by_parameters,
             " by the parameters both have (", by.empty() ? "none" : by,
             "); only in A: ", c.n_only_a, ", only in B: ", c.n_only_b, "\n");
  if (c.n_ambiguous > 0) {
    text += concat(c.n_ambiguous,
                   " cases are not matched because others have the same of these parameters\n");
  }
  if (c.n_same_result > 0) {
    text += concat(c.n_same_result,
                   " share one result of the store: the same case, nothing to compare\n");
  }
  if (c.n_without > 0) text += concat(c.n_without, " have no result in A or in B yet\n");
  return text;
}

std::string verdict_text(const Comparison& c) {
  if (c.pairs.empty()) return "COMPARED NOTHING\n";
  std::string text = concat(
      "compared: ", c.pairs.size(),
      "; identical bit for bit in outcome and all metrics: ", c.count(&ComparedPair::identical),
      "; beyond the tolerance of ", format_number(c.request.tolerance), ": ", c.n_beyond(), "\n");
  text += concat("other outcome: ", c.count(&ComparedPair::outcome_differs),
                 "; sliding in one only: ", c.count(&ComparedPair::flipped), "\n");
  if (c.n_ranked > 1) {
    text += concat("ranking of ", c.n_ranked, " full histories: Kendall's τ-b ",
                   c.tau_b ? format_number(*c.tau_b) : "none (all tied)", "; ", c.n_top_shared,
                   " of the ", c.n_top, " highest of A are among the ", c.n_top, " highest of B\n");
  }
  return text;
}

std::string metrics_text(const Comparison& c) {
  TextTable table({"metric", "compared", "beyond", "in one only", "max difference", "max relative",
                   "case A", "case B"});
  for (const MetricDifference& m : c.metrics) {
    if (m.n_compared + m.n_one_missing == 0) continue;
    table.add_row(
        {name_with_unit(m.metric, c), std::to_string(m.n_compared), std::to_string(m.n_beyond),
         m.n_one_missing > 0 ? std::to_string(m.n_one_missing) : "", format_number(m.max_absolute),
         format_number(m.max_relative, 3), m.worst_a > 0 ? std::to_string(m.worst_a) : "",
         m.worst_b > 0 ? std::to_string(m.worst_b) : ""});
  }
  return table.empty() ? "" : "\n" + table.text();
}

/// How many pairs the table of the worst shows: those that differ at all.
std::size_t n_shown(const Comparison& c) {
  const auto differ = std::count_if(c.pairs.begin(), c.pairs.end(),
                                    [](const ComparedPair& p) { return !p.identical; });
  return static_cast<std::size_t>(c.request.top > 0 ? std::min<long>(c.request.top, differ)
                                                    : differ);
}

std::string worst_text(const Comparison& c) {
  const auto parameters = parameters_from_json(c.a.parameters);
  std::vector<std::string> header = {"case A", "case B"};
  for (const StoredParameter& one : parameters) header.push_back(one.name);
  for (const char* name :
       {"outcome A", "outcome B", "activated", "worst metric", "A", "B", "relative"}) {
    header.emplace_back(name);
  }
  TextTable table(header);
  for (std::size_t k = 0; k < n_shown(c); ++k) {
    const ComparedPair& p = c.pairs[k];
    std::vector<std::string> cells = {std::to_string(p.a), std::to_string(p.b)};
    const std::vector<std::string> labels = labels_of(p.parameters, parameters);
    cells.insert(cells.end(), labels.begin(), labels.end());
    const bool has_metric = p.worst > 0;
    cells.insert(cells.end(),
                 {p.outcome_a, p.outcome_differs ? p.outcome_b : "", p.flipped ? "in one only" : "",
                  has_metric ? name_with_unit(c.metrics[p.worst_metric].metric, c) : "",
                  has_metric ? format_number(p.worst_a, 6) : "",
                  has_metric ? format_number(p.worst_b, 6) : "",
                  has_metric && std::isfinite(p.worst) ? format_number(p.worst, 3) : ""});
    table.add_row(std::move(cells));
  }
  return table.empty() ? "" : "\nthe worst:\n" + table.text();
}

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

json metric_json(const Comparison& c, const MetricDifference& m) {
  return {{"name", m.metric.name},
          {"unit", unit_of(m.metric, c)},
          {"compared", m.n_compared},
          {"in_one_only", m.n_one_missing},
          {"beyond_tolerance", m.n_beyond},
          {"max_absolute", m.max_absolute},
          {"max_relative", m.max_relative},
          {"case_a", m.worst_a > 0 ? json(m.worst_a) : json()},
          {"case_b", m.worst_b > 0 ? json(m.worst_b) : json()}};
}

json pair_json(const Comparison& c, const ComparedPair& p) {
  json one = {{"case_a", p.a},
              {"case_b", p.b},
              {"outcome_a", p.outcome_a},
              {"outcome_b", p.outcome_b},
              {"activated_in_one_only", p.flipped},
              {"worst", json()}};
  if (p.worst > 0) {
    const MetricInfo& metric = c.metrics[p.worst_metric].metric;
    one["worst"] = {{"metric", metric.name},
                    {"unit", unit_of(metric, c)},
                    {"a", number_or_null(p.worst_a)},
                    {"b", number_or_null(p.worst_b)},
                    {"relative", number_or_null(p.worst)}};
  }
  return one;
}

}  // namespace

std::string comparison_to_text(const Comparison& c) {
  return matched_text(c) + verdict_text(c) + metrics_text(c) + worst_text(c);
}

json comparison_to_json(const Comparison& c) {
  json metrics = json::array(), worst = json::array();
  for (const MetricDifference& one : c.metrics) metrics.push_back(metric_json(c, one));
  for (std::size_t k = 0; k < n_shown(c); ++k) worst.push_back(pair_json(c, c.pairs[k]));
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
          {"top_shared", c.n_top_shared},
          {"metrics", metrics},
          {"worst", worst}};
}

}  // namespace faultsweep
