#include "campaign/report/ranking_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/report/parameters.h"
#include "campaign/report/selection.h"
#include "campaign/report/text_table.h"
#include "campaign/spec/metrics.h"

namespace faultsweep {

using faultsim::concat;
using faultsim::Dimension;
using faultsim::InputError;
using nlohmann::json;

namespace {

constexpr const char* kDefaultMetric = "activated_area";

Expression parse_number(const std::string& text, const Symbols& symbols) {
  Expression expression = Expression::parse(text, symbols);
  if (expression.type().kind == Kind::text) {
    throw InputError("--by", {{"", 0, concat("'", text, "' is a word, not a number"),
                               "rank by a metric of --list-metrics"}});
  }
  return expression;
}

std::string flag_of(const RankedCase& row) {
  std::string flag = row.outcome;
  if (!row.weakening_resolved) flag += ", mesh too coarse for its weakening";
  if (row.weakening_resolved && row.rank_class == 1) flag += ", evidence of an event does not hold";
  if (row.unexpected) flag += ", UNEXPECTED";
  return flag;
}

std::string activation_of(const faultsim::StageMetrics& m) {
  if (!m.activated) return "no";
  std::string text = m.activated_fault.empty() ? "yes" : m.activated_fault;
  if (m.activation_step) text += concat(" at step ", *m.activation_step);
  return text;
}

/// The tier that all groups of a resolved spec have, without sizes of their own; "" = no such.
std::string common_tier(const std::string& resolved_spec) {
  std::string tier;
  const json spec = json::parse(resolved_spec);
  for (const json& group : spec.at("groups")) {
    const json& scene = group.at("scene");
    const std::string own = scene.value("tier", std::string());
    const bool has_sizes = scene.contains("mesh") && !scene["mesh"].empty();
    if (own.empty() || has_sizes || (!tier.empty() && own != tier)) return "";
    tier = own;
  }
  return tier;
}

std::vector<ErrorBar> error_bars_of(const Store& store, const CampaignInfo& campaign) {
  std::vector<ErrorBar> bars = store.error_bars(campaign.name);
  if (bars.empty()) return bars;
  const std::string tier = common_tier(store.spec_copies(campaign.id).resolved);
  std::erase_if(bars, [&](const ErrorBar& bar) { return bar.tier != tier; });
  return bars;
}

/// "0.83 ± 0.02" where the metric has an error bar.
std::string with_error(double value, const std::string& metric,
                       const std::vector<ErrorBar>& error_bars) {
  for (const ErrorBar& bar : error_bars) {
    if (bar.metric == metric)
      return concat(format_number(value, 3), " ± ", format_number(bar.rms, 1));
  }
  return format_number(value, 3);
}

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(); }

}  // namespace

Ranking make_ranking(const Store& store, const CampaignInfo& campaign, RankRequest request) {
  if (request.by.empty()) request.by = campaign.rank_by.empty() ? kDefaultMetric : campaign.rank_by;
  check_stage(store, campaign, request.stage);
  const Symbols symbols = result_symbols(campaign);
  Store::RankingQuery query;
  Ranking ranking{campaign, request, request.by == kDefaultMetric && !request.ascending, {}, {}};
  if (!ranking.by_default) query.by = parse_number(request.by, symbols).sql();
  query.where = parse_condition(request.where, symbols);
  query.stage = request.stage;
  query.ascending = request.ascending;
  query.limit = request.top;
  ranking.rows = store.ranking(campaign.id, query);
  if (request.stage.empty()) ranking.error_bars = error_bars_of(store, campaign);
  return ranking;
}

namespace {

/// What stands in the first column. Cases whose sizes are the mesh's compete among themselves,
/// cases without a full history not at all.
class PlaceNames {
 public:
  std::string next(int rank_class) {
    if (rank_class == 0) return std::to_string(++complete_);
    return rank_class == 1 ? concat("+", ++unresolved_) : "*";
  }

 private:
  int complete_ = 0, unresolved_ = 0;
};

std::string footnotes(const Ranking& ranking) {
  const std::vector<RankedCase>& rows = ranking.rows;
  const auto any = [&](auto&& holds) { return std::any_of(rows.begin(), rows.end(), holds); };
  std::string text;
  if (any([](const RankedCase& row) { return row.rank_class == 1; })) {
    text +=
        "+ complete, but the size of its slip events depends on the mesh or is not evident: "
        "ranked apart\n";
  }
  if (any([](const RankedCase& row) { return row.rank_class > 1; })) {
    text += "* history ends early: listed apart, not ranked\n";
  }
  if (any([](const RankedCase& row) { return row.unexpected; })) {
    text += "UNEXPECTED: activated again as pressure recovers\n";
  }
  for (const ErrorBar& bar : ranking.error_bars) {
    text += concat("± of ", bar.metric, " is its rms error at ", bar.tier, " against ",
                   bar.reference, " over ", bar.n_cases, " cases of the campaign, at most ",
                   format_number(bar.largest, 2), " (faultsweep tradeoff)\n");
  }
  return text;
}

}  // namespace

std::string ranking_to_text(const Ranking& ranking) {
  const auto parameters = parameters_from_json(ranking.campaign.parameters);
  std::vector<std::string> header = {"rank", "case"};
  for (const StoredParameter& parameter : parameters) header.push_back(parameter.name);
  for (const char* name : {"outcome", "activated", "area/m2", "M0/Nm", "Mw", "events",
                           "event M0/Nm", "χ̄", "margin/bar", "slip/m"}) {
    header.push_back(name);
  }
  const bool has_score = !ranking.by_default;
  header.push_back(has_score ? ranking.request.by : "");
  TextTable table(header);
  PlaceNames places;
  for (const RankedCase& row : ranking.rows) {
    const faultsim::StageMetrics& m = row.metrics;
    std::vector<std::string> cells = {places.next(row.rank_class), std::to_string(row.position)};
    std::vector<std::string> labels = labels_from_json(row.parameter_labels);
    labels.resize(parameters.size());
    cells.insert(cells.end(), labels.begin(), labels.end());
    constexpr double kBar = 1e5;
    cells.insert(cells.end(),
                 {flag_of(row), activation_of(m), format_number(m.activated_area),
                  format_number(m.moment, 3), m.magnitude ? format_number(*m.magnitude, 2) : "",
                  m.n_events > 0 ? std::to_string(m.n_events) : "",
                  m.n_events > 0 ? format_number(m.event_moment, 3) : "",
                  with_error(m.chi_bar, "chi_bar", ranking.error_bars),
                  row.pressure_margin ? format_number(*row.pressure_margin / kBar, 3) : "",
                  with_error(m.max_slip, "max_slip", ranking.error_bars),
                  has_score ? (row.score ? format_number(*row.score) : "-") : ""});
    table.add_row(std::move(cells));
  }
  if (table.empty()) return "no case of " + ranking.campaign.name + " matches\n";
  return table.text() + footnotes(ranking);
}

json ranking_to_json(const Ranking& ranking) {
  const auto parameters = parameters_from_json(ranking.campaign.parameters);
  json cases = json::array();
  int rank = 0;
  for (const RankedCase& row : ranking.rows) {
    const faultsim::StageMetrics& m = row.metrics;
    json values = json::object();
    const json stored = json::parse(row.parameter_values, nullptr, false);
    const std::vector<std::string> labels = labels_from_json(row.parameter_labels);
    for (std::size_t k = 0; k < parameters.size() && k < stored.size(); ++k) {
      if (stored[k].is_null()) continue;
      values[parameters[k].name] = {
          {"value", stored[k]},
          {"unit", parameters[k].is_text ? "" : faultsim::si_unit(parameters[k].dimension)},
          {"text", k < labels.size() ? labels[k] : ""}};
    }
    json entry = {{"rank", row.rank_class == 0 ? json(++rank) : json()},
                  {"case", row.position},
                  {"parameters", values},
                  {"outcome", row.outcome},
                  {"rank_class", row.rank_class},
                  {"unexpected", row.unexpected},
                  {"weakening_resolved", row.weakening_resolved},
                  {"activated", m.activated},
                  {"activated_fault", m.activated_fault},
                  {"activation_step", m.activation_step ? json(*m.activation_step) : json()},
                  {"activation_pressure_pa", optional_json(m.activation_pressure)},
                  {"activated_area_m2", m.activated_area},
                  {"moment_nm", m.moment},
                  {"magnitude_mw", optional_json(m.magnitude)},
                  {"n_events", m.n_events},
                  {"event_moment_nm", m.event_moment},
                  {"event_magnitude_mw", optional_json(m.event_magnitude)},
                  {"chi_bar", m.chi_bar},
                  {"chi_max", m.chi_max},
                  {"area_chi_080_m2", m.area_chi_080},
                  {"thickness_chi_080_m", m.thickness_chi_080},
                  {"slipping_area_m2", m.slipping_area},
                  {"open_area_m2", m.open_area},
                  {"max_slip_m", m.max_slip},
                  {"potency_m3", m.potency},
                  {"pressure_margin_pa", optional_json(row.pressure_margin)}};
    if (!ranking.by_default) entry["score"] = optional_json(row.score);
    cases.push_back(std::move(entry));
  }
  json bars = json::array();
  for (const ErrorBar& bar : ranking.error_bars) {
    bars.push_back({{"metric", bar.metric},
                    {"tier", bar.tier},
                    {"reference", bar.reference},
                    {"n_cases", bar.n_cases},
                    {"rms", bar.rms},
                    {"largest", bar.largest}});
  }
  return {{"campaign", ranking.campaign.name}, {"error_bars", std::move(bars)},
          {"by", ranking.request.by},          {"stage", ranking.request.stage},
          {"where", ranking.request.where},    {"cases", std::move(cases)}};
}

std::string metrics_to_text() {
  TextTable table({"metric", "unit", "meaning"});
  for (const MetricInfo& metric : metric_catalogue()) {
    table.add_row({metric.name, metric.is_flag ? "yes/no" : faultsim::si_unit(metric.dimension),
                   metric.description});
  }
  return table.text();
}

json metrics_to_json() {
  json all = json::array();
  for (const MetricInfo& metric : metric_catalogue()) {
    all.push_back({{"name", metric.name},
                   {"unit", faultsim::si_unit(metric.dimension)},
                   {"is_flag", metric.is_flag},
                   {"description", metric.description}});
  }
  return all;
}

}  // namespace faultsweep
