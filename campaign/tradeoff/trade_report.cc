#include "campaign/tradeoff/trade_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "campaign/render/text_table.h"
#include "simulator/common/errors.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::counted;
using nlohmann::json;

namespace {

std::string number(double value, int digits = 3) {
  return std::isnan(value) ? "" : format_number(value, digits);
}
std::string percent(double share) {
  if (std::isnan(share)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%+.3g", 100 * share);
  return share == 0 ? "0" : text;
}
std::string in_bar(double pressure) {
  return std::isnan(pressure) ? "" : format_number(pressure / kBar, 4);
}
std::string in_gigabytes(double bytes) { return std::isnan(bytes) ? "" : number(bytes / 1e9, 3); }

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

struct Cells {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

Cells cells_of(const TradeTable& table) {
  Cells cells;
  cells.header = {"choice", "unknowns", "χ̄ off by"};
  if (table.axis.is_mesh) cells.header.insert(cells.header.end(), {"χ̄ in all", "front"});
  for (const char* name : {"activation/bar", "off by", "area/%", "slip/%", "M0/%", "operator/s",
                           "case/s", "memory/GB", "remark"}) {
    cells.header.emplace_back(name);
  }
  for (const TradeRow& row : table.rows) {
    std::vector<std::string> line = {
        row.choice.name,
        row.choice.n_unknowns > 0 ? std::to_string(row.choice.n_unknowns) : std::string(),
        number(row.error.chi, 2)};
    if (table.axis.is_mesh)
      line.insert(line.end(), {number(row.total_chi, 2), row.on_front ? "*" : ""});
    line.insert(line.end(),
                {in_bar(row.metrics.activation_pressure), in_bar(row.error.activation_pressure),
                 percent(row.error.area), percent(row.error.slip), percent(row.error.moment),
                 number(row.run.operator_seconds), number(row.run.case_seconds),
                 in_gigabytes(row.run.peak_bytes), remark_of(row)});
    cells.rows.push_back(std::move(line));
  }
  return cells;
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
    text += table.chi.extrapolated ? concat(", uncertain by ", number(table.chi.uncertainty, 2))
                                   : concat(": orders do not hold, not extrapolated, uncertain by ",
                                            number(table.chi.uncertainty, 2));
  }
  return text;
}

Cells cells_of(const std::vector<RankingTrade>& rankings) {
  Cells cells;
  cells.header = {
      "choice", "against",          "cases", "Kendall τ",         "same of the first", "χ̄ rms",
      "χ̄ max",  "activation flips", "s",     "s of the reference"};
  for (const RankingTrade& one : rankings) {
    cells.rows.push_back({one.choice, one.reference, std::to_string(one.n_cases),
                          one.tau ? number(*one.tau) : "",
                          concat(one.n_top_common, " of ", one.n_top), number(one.chi_rms, 2),
                          number(one.chi_max, 2), std::to_string(one.n_flips), number(one.seconds),
                          number(one.reference_seconds)});
  }
  return cells;
}

std::string screen_table(const Cells& cells) {
  TextTable table(cells.header);
  for (const auto& row : cells.rows) table.add_row(row);
  return table.text();
}

std::string markdown_table(const Cells& cells) {
  std::vector<bool> is_used(cells.header.size(), false);
  for (const auto& row : cells.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) is_used[k] = is_used[k] || !row[k].empty();
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string text = "|";
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (is_used[k]) text += " " + row[k] + " |";
    }
    return text + "\n";
  };
  std::string text = line(cells.header);
  text += line(std::vector<std::string>(cells.header.size(), "---"));
  for (const auto& row : cells.rows) text += line(row);
  return text;
}

/// True where some fault comes near its strength at all.
bool chi_says_something(const ChiHistory& history) {
  constexpr double kNothing = 1e-3;
  return std::any_of(history.chi.begin(), history.chi.end(),
                     [](double chi) { return chi > kNothing; });
}

/// True where the scene is in 3D but no mesh of it was run in 3D.
bool lacks_space(const TradeReport& report) {
  const auto& tables = report.trade.tables;
  const bool is_3d = std::any_of(tables.begin(), tables.end(), [](const TradeTable& table) {
    return table.axis.name == "cells, 3D";
  });
  return is_3d && !report.trade.plane_strain;
}

std::string recommendation(const TradeReport& report) {
  const MeshReference& reference = report.trade.reference;
  if (!chi_says_something(reference.history)) {
    return "No mesh is recommended: χ̄ is nowhere above 0.001, or there is none; judge by slip and "
           "M0.";
  }
  if (!(reference.uncertainty <= report.wanted_chi)) {
    return concat("No mesh can be recommended for χ̄ within ", number(report.wanted_chi),
                  ": what they are measured against is itself uncertain by ",
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
      lacks_space(report) ? "; 3D was not run, what plane strain costs is not in that." : ".");
}

}  // namespace

namespace {

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
    if (row.error.activation_pressure == 0) text += " and leave the pressure of activation";
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
  text += std::isnan(cost->uncertainty) ? std::string("no finer pair says how certain that is)")
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
  std::string text = concat(
      one.choice, " ranks ", one.n_cases,
      " cases with Kendall's τ = ", one.tau ? number(*one.tau) : std::string("(all tied)"), " to ",
      one.reference, ": ", one.n_top_common, " of its first ", one.n_top, " are among the first ",
      one.n_top, " there, ", counted(one.n_flips, "activation flips", "activations flip"),
      ", χ̄ is off by ", number(one.chi_rms, 2), " (rms, at most ", number(one.chi_max, 2), "), in ",
      number(one.seconds), " s instead of ", number(one.reference_seconds), " s.");
  return text;
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

std::string trade_to_text(const TradeReport& report) {
  std::string text;
  for (const TradeTable& table : report.trade.tables) {
    text += concat("== ", table.axis.name, ": ", table.axis.question, "\n",
                   screen_table(cells_of(table)), reference_of(table), "\n\n");
  }
  if (!report.rankings.empty()) {
    text += concat("== ranking\n", screen_table(cells_of(report.rankings)), "\n");
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
    text += concat("\n## Ranking\n\n", markdown_table(cells_of(report.rankings)));
  }
  for (const TradeTable& table : report.trade.tables) {
    text += concat("\n## ", table.axis.name, "\n\n", table.axis.question, "\n\n",
                   markdown_table(cells_of(table)), "\n", reference_of(table), "\n");
  }
  return text;
}

namespace {

json known(double value) { return std::isnan(value) ? json() : json(value); }

json metrics_json(const TradeMetrics& metrics) {
  return {{"activation_pressure_pa", known(metrics.activation_pressure)},
          {"activated_area_m2", known(metrics.area)},
          {"max_slip_m", known(metrics.slip)},
          {"moment_nm", known(metrics.moment)}};
}

json row_json(const TradeRow& row) {
  json changes = json::object();
  for (const Change& change : row.choice.changes) changes[change.pointer] = change.value;
  return {{"choice", row.choice.name},
          {"changes", changes},
          {"size", row.choice.size > 0 ? json(row.choice.size) : json()},
          {"unknowns", row.choice.n_unknowns},
          {"jump_unknowns", row.choice.n_jump},
          {"remark", remark_of(row)},
          {"outcome", row.run.result ? json(faultsim::to_string(row.run.result->outcome)) : json()},
          {"metrics", metrics_json(row.metrics)},
          {"error_chi", known(row.error.chi)},
          {"error_chi_where", row.error.where},
          {"error_chi_in_all", known(row.total_chi)},
          {"activation_flips", row.error.activation_flips},
          {"error_activation_pressure_pa", known(row.error.activation_pressure)},
          {"relative_error_area", known(row.error.area)},
          {"relative_error_slip", known(row.error.slip)},
          {"relative_error_moment", known(row.error.moment)},
          {"operator_s", known(row.run.operator_seconds)},
          {"case_s", known(row.run.case_seconds)},
          {"peak_bytes", known(row.run.peak_bytes)},
          {"pareto", row.on_front}};
}

}  // namespace

json trade_to_json(const TradeReport& report) {
  json axes = json::array();
  for (const TradeTable& table : report.trade.tables) {
    json rows = json::array();
    for (const TradeRow& row : table.rows) rows.push_back(row_json(row));
    axes.push_back({{"axis", table.axis.name},
                    {"question", table.axis.question},
                    {"reference", table.reference},
                    {"reference_metrics", metrics_json(table.limits)},
                    {"order", known(table.chi.order)},
                    {"extrapolated", table.chi.extrapolated},
                    {"uncertainty_chi", known(table.chi_uncertainty)},
                    {"choices", rows}});
  }
  json rankings = json::array();
  for (const RankingTrade& one : report.rankings) {
    rankings.push_back({{"choice", one.choice},
                        {"reference", one.reference},
                        {"n_cases", one.n_cases},
                        {"kendall_tau_b", one.tau ? json(*one.tau) : json()},
                        {"n_top", one.n_top},
                        {"n_top_common", one.n_top_common},
                        {"activation_flips", one.n_flips},
                        {"chi_rms", known(one.chi_rms)},
                        {"chi_max", known(one.chi_max)},
                        {"seconds", one.seconds},
                        {"reference_seconds", one.reference_seconds}});
  }
  return {{"format", 1},
          {"title", report.title},
          {"scene", report.source},
          {"wanted_chi", report.wanted_chi},
          {"answers", trade_answers(report)},
          {"reference", report.trade.reference.text},
          {"reference_uncertainty_chi", known(report.trade.reference.uncertainty)},
          {"axes", axes},
          {"rankings", rankings}};
}

}  // namespace faultsweep
