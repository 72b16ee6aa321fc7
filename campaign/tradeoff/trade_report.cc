#include "campaign/tradeoff/trade_report.h"

#include <algorithm>
#include <cmath>

#include "campaign/render/render.h"
#include "campaign/render/shown.h"

namespace faultsweep {

namespace {

std::string number(double value, int digits = 3) {
  return std::isnan(value) ? "" : format_number(value, digits);
}
std::string in_bar(double pressure) {
  return std::isnan(pressure) ? "" : format_number(pressure / kBar, 4);
}

std::string remark_of(const TradeRow& row) {
  if (!row.choice.left_out.empty()) return row.choice.left_out;
  if (!row.run.result) return row.run.trouble;
  std::string text;
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  const faultsim::CaseResult& result = *row.run.result;
  if (result.outcome != faultsim::Outcome::converged) add(faultsim::to_string(result.outcome));
  if (!result.weakening_resolved) add("too coarse for its weakening");
  if (row.error.activation_flips) add("ACTIVATION FLIPS");
  return text;
}

/// A choice per row; in files as trade.json has them, but for what the choice changes.
AnswerTable table_of(const TradeTable& trade) {
  const Need mesh = trade.axis.is_mesh ? Need::wanted : Need::data, all = Need::always,
             wanted = Need::wanted, extra = Need::extra, data = Need::data;
  AnswerTable table{"choices",
                    "",
                    {{"choice", "choice", {}, 4, all},
                     {"size", "size", metres(), 4, data},
                     {"unknowns", "unknowns", {}, 4, all},
                     {"jump_unknowns", "jumps", {}, 4, data},
                     {"error_chi", "χ̄ off by", {}, 2, all},
                     {"error_chi_where", "where", {}, 4, data},
                     {"error_chi_in_all", "χ̄ in all", {}, 2, mesh},
                     {"pareto", "front", {}, 4, mesh},
                     {"activation_pressure_pa", "activation", bars(), 4, wanted, "metrics"},
                     {"activated_area_m2", "sliding area", {"m2", 1, "m2"}, 4, data, "metrics"},
                     {"max_slip_m", "slip", metres(), 4, data, "metrics"},
                     {"moment_nm", "M0", {"N m", 1, "N m"}, 4, data, "metrics"},
                     {"error_activation_pressure_pa", "off by", bars(), 4, wanted},
                     {"activation_flips", "activation flips", {}, 4, data},
                     {"relative_error_area", "area", percent(), 3, extra},
                     {"relative_error_slip", "slip", percent(), 3, extra},
                     {"relative_error_moment", "M0", percent(), 3, extra},
                     {"operator_s", "operator", seconds(), 3, wanted},
                     {"case_s", "case", seconds(), 3, wanted},
                     {"peak_bytes", "memory", gigabytes(), 3, extra},
                     {"outcome", "outcome", {}, 4, data},
                     {"remark", "remark", {}, 4, all}}};
  for (const TradeRow& row : trade.rows) {
    const TradeMetrics& m = row.metrics;
    const auto& result = row.run.result;
    table.rows.push_back({row.choice.name,
                          row.choice.size > 0 ? AnswerCell(row.choice.size) : AnswerCell(),
                          row.choice.n_unknowns,
                          row.choice.n_jump,
                          row.error.chi,
                          row.error.where,
                          row.total_chi,
                          row.on_front,
                          m.activation_pressure,
                          m.area,
                          m.slip,
                          m.moment,
                          row.error.activation_pressure,
                          row.error.activation_flips,
                          row.error.area,
                          row.error.slip,
                          row.error.moment,
                          row.run.operator_seconds,
                          row.run.case_seconds,
                          row.run.peak_bytes,
                          result ? AnswerCell(faultsim::to_string(result->outcome)) : AnswerCell(),
                          remark_of(row)});
  }
  return table;
}

/// What `χ̄ in all` is measured against.
std::string reference_of_meshes(const TradeReport& report) {
  const MeshReference& reference = report.trade.reference;
  if (reference.text.empty()) return "";
  return concat("`χ̄ in all` is measured against ", reference.text, "; uncertain by ",
                std::isnan(reference.uncertainty) ? std::string("an unknown amount")
                                                  : number(reference.uncertainty, 2),
                ".\n");
}

std::string reference_of(const TradeTable& table) {
  if (table.reference.empty()) return "nothing to compare with";
  std::string text = "reference: " + table.reference;
  if (table.axis.converges && !std::isnan(table.chi.order)) {
    text += concat("; observed order of χ̄ ", number(table.chi.order, 2));
    text += table.chi.extrapolated
                ? concat(", uncertain by ", number(table.chi.uncertainty, 2))
                : concat(": the orders are inconsistent, not extrapolated, uncertain by ",
                         number(table.chi.uncertainty, 2));
  }
  return text;
}

AnswerTable table_of(const std::vector<RankingTrade>& rankings) {
  const Need all = Need::always, wanted = Need::wanted;
  AnswerTable table{"rankings",
                    "",
                    {{"choice", "choice", {}, 4, all},
                     {"reference", "against", {}, 4, all},
                     {"n_cases", "cases", {}, 4, all},
                     {"kendall_tau_b", "Kendall τ", {}, 3, all},
                     {"n_top_common", "the same", {}, 4, all},
                     {"n_top", "of the first", {}, 4, all},
                     {"chi_rms", "χ̄ rms", {}, 2, wanted},
                     {"chi_max", "χ̄ max", {}, 2, all},
                     {"activation_flips", "activation flips", {}, 4, wanted},
                     {"seconds", "it takes", seconds(), 3, wanted},
                     {"reference_seconds", "the reference", seconds(), 3, wanted}}};
  for (const RankingTrade& one : rankings) {
    table.rows.push_back({one.choice, one.reference, one.n_cases, one.tau, one.n_top_common,
                          one.n_top, one.chi_rms, one.chi_max, one.n_flips, one.seconds,
                          one.reference_seconds});
  }
  return table;
}

/// Of the columns that a screen has, those with something in them.
std::string markdown_table(const AnswerTable& table) {
  std::string heading = "|", rule = "|";
  std::vector<std::string> lines(table.rows.size(), "|");
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const AnswerColumn& column = table.columns[k];
    if (column.need == Need::data) continue;
    std::vector cells =
        mapped(table.rows, [&](const auto& row) { return shown_cell(row[k], column); });
    if (std::ranges::all_of(cells, &std::string::empty)) continue;
    heading += " " + shown_heading(column) + " |";
    rule += " --- |";
    for (std::size_t r = 0; r < cells.size(); ++r) lines[r] += " " + cells[r] + " |";
  }
  std::string text = heading + "\n" + rule + "\n";
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// True where some fault comes near its strength at all.
bool chi_says_something(const ChiHistory& history) {
  constexpr double kNothing = 1e-3;
  return std::ranges::any_of(history.chi, [](double chi) { return chi > kNothing; });
}

/// True where the scene is in 3D but no mesh of it was run in 3D.
bool lacks_space(const TradeReport& report) {
  const auto& tables = report.trade.tables;
  const bool is_3d = std::ranges::any_of(
      tables, [](const TradeTable& table) { return table.axis.name == "cells, 3D"; });
  return is_3d && !report.trade.plane_strain;
}

std::string recommendation(const TradeReport& report) {
  const MeshReference& reference = report.trade.reference;
  if (!chi_says_something(reference.history)) {
    return "No mesh is recommended, as χ̄ is missing or nowhere above 0.001; judge by slip and M0.";
  }
  if (!(reference.uncertainty <= report.wanted_chi)) {
    return concat("No mesh can be recommended for χ̄ within ", number(report.wanted_chi),
                  ": the reference is itself uncertain by ",
                  std::isnan(reference.uncertainty) ? std::string("an unknown amount")
                                                    : number(reference.uncertainty, 2),
                  "; allow finer cells (--operator-limit, --memory).");
  }
  const TradeRow* row = recommended(report.trade, report.wanted_chi);
  if (row == nullptr) {
    return concat("No mesh that was run keeps χ̄ within ", number(report.wanted_chi),
                  " of the reference.");
  }
  return concat(
      "For χ̄ within ", number(report.wanted_chi), ": ", row->choice.name,
      row->choice.plane_strain ? ", plane strain" : ", 3D", ", which is off by ",
      number(row->total_chi, 2), " and takes ", number(row->seconds()), " s with its operator",
      lacks_space(report) ? "; 3D was not run, so this leaves out what plane strain costs." : ".");
}

/// What the choice of that axis costs, in one sentence; "" where it was not run.
std::string sentence(const TradeReport& report, const std::string& axis, std::size_t choice,
                     const std::string& subject) {
  for (const TradeTable& table : report.trade.tables) {
    if (table.axis.name != axis || choice >= table.rows.size()) continue;
    const TradeRow& row = table.rows[choice];
    if (std::isnan(row.error.chi)) return "";
    std::string text =
        concat(subject, ", ", row.choice.name, ", cost up to ", number(row.error.chi, 2), " in χ̄");
    if (row.error.chi > 0) text += concat(" (", row.error.where, ")");
    if (row.error.activation_pressure == 0) text += " and do not change the pressure of activation";
    if (std::abs(row.error.activation_pressure) > 0)
      text += concat(" and ", in_bar(std::abs(row.error.activation_pressure)),
                     " bar in the pressure of activation");
    if (row.error.activation_flips) text += ", and activation flips";
    return text + ".";
  }
  return "";
}

std::string plane_strain_sentence(const TradeReport& report) {
  const auto& cost = report.trade.plane_strain;
  if (!cost) return "";
  std::string text =
      concat("Plane strain costs up to ", number(cost->chi(), 2), " in χ̄: ", number(cost->plane, 3),
             " instead of ", number(cost->space, 3), " in 3D (", cost->where, ", cells of ",
             number(cost->cells), " m in both; ");
  text += std::isnan(cost->uncertainty) ? std::string("no finer pair shows how certain that is)")
                                        : concat("the last refinement changed that by up to ",
                                                 number(cost->uncertainty, 2), ")");
  const double earlier = cost->activation_pressure;
  if (earlier == 0) text += "; activation at the same pressure";
  if (std::abs(earlier) > 0) {
    text += concat("; the first fault activates ", in_bar(std::abs(earlier)),
                   earlier > 0 ? " bar earlier" : " bar later");
  }
  if (cost->activation_flips) text += "; activation flips";
  return text + ".";
}

std::string ranking_sentence(const RankingTrade& one) {
  return concat(
      one.choice, " ranks ", one.n_cases,
      " cases with Kendall's τ = ", one.tau ? number(*one.tau) : std::string("(all tied)"), " to ",
      one.reference, ": ", one.n_top_common, " of its first ", one.n_top, " are among the first ",
      one.n_top, " there, ", counted(one.n_flips, "activation flips", "activations flip"),
      ", χ̄ is off by ", number(one.chi_rms, 2), " (rms, at most ", number(one.chi_max, 2), "), in ",
      number(one.seconds), " s instead of ", number(one.reference_seconds), " s.");
}

json known(double value) { return std::isnan(value) ? json() : json(value); }

json metrics_json(const TradeMetrics& metrics) {
  return {{"activation_pressure_pa", known(metrics.activation_pressure)},
          {"activated_area_m2", known(metrics.area)},
          {"max_slip_m", known(metrics.slip)},
          {"moment_nm", known(metrics.moment)}};
}

json choices_json(const TradeTable& table) {
  json rows = json_rows(table_of(table));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    json& changes = rows[k]["changes"] = json::object();
    for (const Change& change : table.rows[k].choice.changes)
      changes[change.pointer] = change.value;
  }
  return rows;
}

}  // namespace

std::vector<std::string> trade_answers(const TradeReport& report) {
  std::vector<std::string> all = {plane_strain_sentence(report)};
  for (const RankingTrade& one : report.rankings) all.push_back(ranking_sentence(one));
  all.push_back(sentence(report, "salt steps", 2, "Salt steps"));
  all.push_back(sentence(report, "load steps", 0, "Load steps"));
  all.push_back(recommendation(report));
  std::erase(all, "");
  return all;
}

std::string trade_to_text(const TradeReport& report, std::size_t width) {
  std::string text;
  for (const TradeTable& table : report.trade.tables) {
    text += concat("== ", table.axis.name, ": ", table.axis.question, "\n",
                   render_text(table_of(table), width), reference_of(table), "\n\n");
  }
  if (!report.rankings.empty()) {
    text += concat("== ranking\n", render_text(table_of(report.rankings), width), "\n");
  }
  text += reference_of_meshes(report);
  for (const std::string& answer : trade_answers(report)) text += answer + "\n";
  return text;
}

std::string trade_to_markdown(const TradeReport& report) {
  std::string text = concat("# The trade: ", report.title, "\n\n");
  for (const std::string& answer : trade_answers(report)) text += "* " + answer + "\n";
  text += "\n![Error against cost](pareto.svg) ![Error against size](convergence.svg)\n";
  text += "\n" + reference_of_meshes(report);
  if (!report.rankings.empty()) {
    text += concat("\n## Ranking\n\n", markdown_table(table_of(report.rankings)));
  }
  for (const TradeTable& table : report.trade.tables) {
    text += concat("\n## ", table.axis.name, "\n\n", table.axis.question, "\n\n",
                   markdown_table(table_of(table)), "\n", reference_of(table), "\n");
  }
  return text;
}

json trade_to_json(const TradeReport& report) {
  json axes = json::array();
  for (const TradeTable& table : report.trade.tables) {
    axes.push_back({{"axis", table.axis.name},
                    {"question", table.axis.question},
                    {"converges", table.axis.converges},
                    {"reference", table.reference},
                    {"reference_metrics", metrics_json(table.limits)},
                    {"order", known(table.chi.order)},
                    {"extrapolated", table.chi.extrapolated},
                    {"uncertainty_chi", known(table.chi_uncertainty)},
                    {"choices", choices_json(table)}});
  }
  return {{"format", 1},
          {"title", report.title},
          {"scene", report.source},
          {"wanted_chi", report.wanted_chi},
          {"answers", trade_answers(report)},
          {"reference", report.trade.reference.text},
          {"reference_uncertainty_chi", known(report.trade.reference.uncertainty)},
          {"axes", axes},
          {"rankings", json_rows(table_of(report.rankings))}};
}

}  // namespace faultsweep
