#include "campaign/report/ranking_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "campaign/report/error_bars.h"
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

Expression parse_number(const std::string& text, const CampaignInfo& campaign,
                        const Selection& selection) {
  Expression expression =
      Expression::parse(text, result_symbols(campaign, selection), scopes_of(selection));
  if (expression.type().kind == Kind::text) {
    throw InputError("--by", {{"", 0, concat("'", text, "' is a word, not a number"),
                               "rank by a metric of --list-metrics"}});
  }
  return expression;
}

/// The first area, potency or moment that an expression is made of; "" = none.
std::string first_extensive(const Expression& expression, const Selection& selection) {
  const auto known = known_metrics(selection);
  for (const std::string& name : expression.names()) {
    const auto found = known.find(name);
    if (found != known.end() && found->second.is_extensive()) return name;
  }
  return "";
}

/// What the row is about: the case, or the fault that was asked for.
faultsim::StageMetrics shown(const RankedCase& row) {
  faultsim::StageMetrics m = row.metrics;
  if (!row.fault_metrics) return m;
  const faultsim::FaultStageMetrics& f = *row.fault_metrics;
  static_cast<faultsim::Measures&>(m) = f;
  m.faults = {f};
  m.activation_step = f.activation ? std::optional(f.activation->step) : std::nullopt;
  m.opening_step = f.opening ? std::optional(f.opening->step) : std::nullopt;
  m.activated_fault = f.activated ? f.fault : "";
  m.opened_fault = f.opens ? f.fault : "";
  return m;
}

/// A ranking of one fault says nothing of what another one does.
bool is_unexpected(const RankedCase& row) {
  return !row.unexpected_fault.empty() &&
         (!row.fault_metrics || row.fault_metrics->fault == row.unexpected_fault);
}

std::string flag_of(const RankedCase& row) {
  std::string flag = row.outcome;
  if (!row.weakening_resolved) flag += ", mesh too coarse for its weakening";
  const bool unresolved_event = row.outcome == to_string(faultsim::Outcome::unresolved_event);
  if (row.weakening_resolved && unresolved_event) flag += ", evidence of an event does not hold";
  if (is_unexpected(row)) flag += concat(", UNEXPECTED (", row.unexpected_fault, ")");
  return flag;
}

std::string sliding_of(const faultsim::StageMetrics& m) {
  const std::string text = m.activated ? first_fault(true, m.activated_fault, m.activation_step)
                           : m.slips   ? "no, slips"
                                       : "no";
  return text + (m.activation_resolved ? "" : ", unresolved");
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
  const bool own_choice = request.by.empty();
  if (own_choice) request.by = campaign.rank_by.empty() ? kDefaultMetric : campaign.rank_by;
  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  Store::RankingQuery query;
  Ranking ranking{campaign, request, request.by == kDefaultMetric && !request.ascending, {}, false,
                  {},       {}};
  query.where = parse_condition(request.where, campaign, selection);
  query.stage = request.stage;
  if (selection.fault) query.fault = selection.fault->id;
  query.ascending = request.ascending;
  query.limit = request.top;
  std::string extensive = kDefaultMetric;
  if (!ranking.by_default) {
    const Expression by = parse_number(request.by, campaign, selection);
    query.by = by.sql();
    extensive = first_extensive(by, selection);
  }
  ranking.kinds = store.kinds(campaign.id, query);
  if (own_choice && !extensive.empty() && ranking.kinds.mixed()) {
    ranking.plane_strain_apart = true;
    const std::string totals = "not plane_strain";
    query.where = parse_condition(
        request.where.empty() ? totals : concat("(", request.where, ") and ", totals), campaign,
        selection);
    ranking.kinds = store.kinds(campaign.id, query);
  }
  if (!extensive.empty()) refuse_mixed(ranking.kinds, "--by", extensive);
  ranking.rows = store.ranking(campaign.id, query);
  if (request.stage.empty() && request.fault.empty())
    ranking.error_bars = error_bars_of(store, campaign);
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
        "+ complete, but whether a fault slides (unresolved) or how large its slip events are "
        "hangs "
        "on the mesh, or events are not evident: ranked apart\n";
  }
  if (any([](const RankedCase& row) { return row.rank_class > 1; })) {
    text += "* history ends early: listed apart, not ranked\n";
  }
  if (any(is_unexpected)) {
    text +=
        "UNEXPECTED: a fault slides after its pressure has recovered that slid before; "
        "`faultsweep show CASE` says where\n";
  }
  if (any([](const RankedCase& row) { return shown(row).activated; })) {
    text +=
        "Δp, p: change, and absolute pressure at the depth beside, of the region next to the "
        "fault where it slides first\n";
  }
  if (ranking.plane_strain_apart) {
    text +=
        "plane-strain cases have no place here, their areas and moments are per metre of strike: "
        "--where plane_strain\n";
  }
  if (ranking.kinds.mixed()) text += "/m: per metre of strike, of plane-strain cases\n";
  for (const ErrorBar& bar : ranking.error_bars) {
    text += concat("± of ", bar.metric, " is its rms error at ", bar.tier, " against ",
                   bar.reference, " over ", bar.n_cases, " cases of the campaign, at most ",
                   format_number(bar.largest, 2), " (faultsweep tradeoff)\n");
  }
  return text;
}

}  // namespace

namespace {

/// "area/m2", "area/(m2/m)" where all rows are per metre of strike.
std::string heading(const std::string& what, const char* unit, const Ranking& ranking) {
  const bool per_metre = ranking.kinds.plane_strain && !ranking.kinds.total;
  return per_metre ? concat(what, "/(", unit, "/m)") : concat(what, "/", unit);
}

/// Of mixed kinds each number says what it is.
std::string extensive(double value, int digits, const RankedCase& row, const Ranking& ranking) {
  return format_number(value, digits) + (ranking.kinds.mixed() && row.plane_strain ? " /m" : "");
}

std::vector<std::string> metric_cells(const RankedCase& row, const Ranking& ranking) {
  const faultsim::StageMetrics m = shown(row);
  const faultsim::FaultOnset* onset = first_activation(m);
  const auto change = onset != nullptr ? leading_change(onset->pressures) : std::nullopt;
  const auto absolute = onset != nullptr ? leading_absolute(onset->pressures) : std::nullopt;
  const bool jumps = m.n_events > 0;
  return {flag_of(row),
          sliding_of(m),
          change ? format_number(*change / kBar, 4) : "",
          absolute ? format_number(*absolute / kBar, 4) : "",
          onset != nullptr ? format_number(onset->depth, 4) : "",
          first_fault(m.opens, m.opened_fault, m.opening_step),
          m.opens ? extensive(m.open_area, 4, row, ranking) : "",
          extensive(m.activated_area, 4, row, ranking),
          extensive(m.moment, 3, row, ranking),
          jumps ? std::to_string(m.n_events) : "",
          jumps ? extensive(m.event_moment, 3, row, ranking) : "",
          m.event_magnitude ? format_number(*m.event_magnitude, 2) : "",
          with_error(m.chi_bar, "chi_bar", ranking.error_bars),
          row.pressure_margin ? format_number(*row.pressure_margin / kBar, 3) : "",
          with_error(m.max_slip, "max_slip", ranking.error_bars)};
}

}  // namespace

std::string ranking_to_text(const Ranking& ranking) {
  const auto parameters = parameters_from_json(ranking.campaign.parameters);
  std::vector<std::string> header = {"rank", "case"};
  for (const StoredParameter& parameter : parameters) header.push_back(parameter.name);
  for (std::string name :
       {std::string("outcome"), std::string("slides"), std::string("Δp/bar"), std::string("p/bar"),
        std::string("depth/m"), std::string("opens"), heading("open", "m2", ranking),
        heading("area", "m2", ranking), heading("M0", "Nm", ranking), std::string("events"),
        heading("event M0", "Nm", ranking), std::string("event Mw"), std::string("χ̄"),
        std::string("margin/bar"), std::string("slip/m")}) {
    header.push_back(std::move(name));
  }
  const bool has_score = !ranking.by_default;
  header.push_back(has_score ? ranking.request.by : "");
  TextTable table(header);
  PlaceNames places;
  for (const RankedCase& row : ranking.rows) {
    std::vector<std::string> cells = {places.next(row.rank_class), std::to_string(row.position)};
    const std::vector<std::string> labels = labels_of(row.parameters, parameters);
    cells.insert(cells.end(), labels.begin(), labels.end());
    for (std::string& cell : metric_cells(row, ranking)) cells.push_back(std::move(cell));
    cells.push_back(has_score ? (row.score ? format_number(*row.score) : "-") : "");
    table.add_row(std::move(cells));
  }
  if (table.empty()) return "no case of " + ranking.campaign.name + " matches\n";
  return table.text() + footnotes(ranking);
}

namespace {

json onset_json(const faultsim::FaultOnset* onset) {
  if (onset == nullptr) return {};
  const faultsim::SidePressures& p = onset->pressures;
  return {{"step", onset->step},
          {"depth_m", onset->depth},
          {"region_minus", p.region_minus},
          {"change_minus_pa", optional_json(p.change_minus)},
          {"absolute_minus_pa", optional_json(p.absolute_minus)},
          {"region_plus", p.region_plus},
          {"change_plus_pa", optional_json(p.change_plus)},
          {"absolute_plus_pa", optional_json(p.absolute_plus)},
          {"change_in_fault_pa", p.change_in_fault}};
}

void add_measures(json& entry, const faultsim::Measures& measures, bool plane_strain) {
  faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto& value) {
    const std::string_view key = field.called.empty() ? field.key : field.called;
    const bool per_metre = plane_strain && faultsim::is_extensive(field.key);
    json& cell = entry[concat(key, per_metre ? "_per_m" : "")];
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
      cell = value;
    } else {
      cell = optional_json(value);
    }
  });
}

}  // namespace

json ranking_to_json(const Ranking& ranking) {
  const auto parameters = parameters_from_json(ranking.campaign.parameters);
  json cases = json::array();
  int rank = 0;
  for (const RankedCase& row : ranking.rows) {
    const faultsim::StageMetrics m = shown(row);
    json entry = {{"rank", row.rank_class == 0 ? json(++rank) : json()},
                  {"case", row.position},
                  {"parameters", values_to_json(row.parameters, parameters)},
                  {"outcome", row.outcome},
                  {"rank_class", row.rank_class},
                  {"unexpected", is_unexpected(row)},
                  {"unexpected_fault", is_unexpected(row) ? row.unexpected_fault : ""},
                  {"weakening_resolved", row.weakening_resolved},
                  {"plane_strain", row.plane_strain},
                  {"jumps", m.n_events > 0},
                  {"activated_fault", m.activated_fault},
                  {"activation_step", m.activation_step ? json(*m.activation_step) : json()},
                  {"activation", onset_json(first_activation(m))},
                  {"opened_fault", m.opened_fault},
                  {"opening", onset_json(first_opening(m))},
                  {"pressure_margin_pa", optional_json(row.pressure_margin)}};
    add_measures(entry, m, row.plane_strain);
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
  return {{"campaign", ranking.campaign.name},
          {"error_bars", std::move(bars)},
          {"by", ranking.request.by},
          {"stage", ranking.request.stage},
          {"fault", ranking.request.fault},
          {"where", ranking.request.where},
          {"plane_strain_apart", ranking.plane_strain_apart},
          {"cases", std::move(cases)}};
}

std::string metrics_to_text() {
  TextTable table({"metric", "unit", "per fault", "meaning"});
  for (const MetricInfo& metric : metric_catalogue()) {
    const std::string unit = metric_unit(metric, false);
    table.add_row({metric.name + (metric.synonym.empty() ? "" : ", " + metric.synonym),
                   metric.is_flag          ? "yes/no"
                   : metric.is_extensive() ? concat(unit, " or ", metric_unit(metric, true))
                                           : unit,
                   has_faults(metric.name) ? "yes" : "", metric.description});
  }
  return table.text() +
         "per fault and stage: F2.max_slip in gas_storage; a unit per m is that of plane strain\n";
}

json metrics_to_json() {
  json all = json::array();
  for (const MetricInfo& metric : metric_catalogue()) {
    all.push_back({{"name", metric.name},
                   {"synonym", metric.synonym},
                   {"unit", metric_unit(metric, false)},
                   {"unit_of_plane_strain", metric_unit(metric, true)},
                   {"is_flag", metric.is_flag},
                   {"per_stage", has_stages(metric.name)},
                   {"per_fault", has_faults(metric.name)},
                   {"description", metric.description}});
  }
  return all;
}

}  // namespace faultsweep
