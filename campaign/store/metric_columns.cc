#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "campaign/common/names.h"
#include "campaign/store/queries.h"
#include "campaign/store/store.h"
#include "simulator/result/measures.h"

/// Metrics of spec/metrics.h as SQL.
namespace faultsweep {
namespace {

/// What a metric is read from.
struct MetricColumn {
  /// "$" stands for a row of stage_metrics or, of one fault, of fault_metrics; "$F" for the fault
  /// that slides first, or for the one; "$O" the same of opening. "m." is the row of case_metrics.
  std::string sql;
  bool of_fault = false;      ///< fault_metrics has it too.
  std::string together = "";  ///< in place of sql for all faults together; "" = the same.
};

/// The place where a fault slides, or opens, first.
MetricColumn onset(const char* column, bool opening) {
  return {
      concat(
          "(SELECT ", column, " FROM leading_onsets WHERE case_id = $.case_id AND stage_id =",
          " $.stage_id AND opening = ", opening ? "1 AND fault_id = $O)" : "0 AND fault_id = $F)"),
      true};
}

/// Creep is kept per load step only: few ask for it, and a case's steps lie together.
MetricColumn creep(const char* aggregate, const char* table) {
  return {concat("(SELECT ", aggregate, " FROM ", table, " WHERE case_id = s.case_id",
                 " AND step BETWEEN s.first_step AND s.last_step)")};
}

std::map<std::string, MetricColumn> all_columns() {
  std::map<std::string, MetricColumn> columns = {
      {"creep_normal_min", creep("min(creep_normal_min_pa)", "chi_history")},
      {"creep_normal_max", creep("max(creep_normal_max_pa)", "chi_history")},
      {"creep_shear_max", creep("max(creep_shear_max_pa)", "chi_history")},
      {"creep_time_steps", creep("sum(time_steps)", "load_steps")},
      {"creep_time_error", creep("max(time_error_pa)", "load_steps")},
      {"creep_time_resolved", creep("min(time_resolved)", "load_steps")},
      {"outcome", {"m.outcome"}},
      {"rank_class", {"$.rank_class", true}},
      {"jumps", {"($.n_events > 0)", true}},
      {"activation_step", {onset("step", false).sql, true, "$.activation_step"}},
      {"activation_depth", onset("depth_m", false)},
      {"activation_pressure_change", onset("change_pa", false)},
      {"activation_pressure_absolute", onset("absolute_pa", false)},
      {"activation_change_before", onset("change_before_pa", false)},
      {"activation_change_in_fault", onset("change_in_fault_pa", false)},
      {"opening_change_in_fault", onset("change_in_fault_pa", true)},
      {"opening_step", {onset("step", true).sql, true, "$.opening_step"}},
      {"opening_depth", onset("depth_m", true)},
      {"opening_pressure_change", onset("change_pa", true)},
      {"opening_pressure_absolute", onset("absolute_pa", true)},
      {"activated_fault", {"(SELECT name FROM names WHERE id = $.activated_fault_id)"}},
      {"opened_fault", {"(SELECT name FROM names WHERE id = $.opened_fault_id)"}},
      {"magnitude_if_released_at_once", {"$.magnitude_if_released_at_once_mw"}},
      {"pressure_margin", {"m.pressure_margin_pa"}},
      {"failed_step", {"m.failed_step"}},
      {"plane_strain", {"m.plane_strain"}},
      {"weakening_resolved", {"m.weakening_resolved"}},
      {"interpolated",
       {"iif(m.case_id IS NULL, NULL, EXISTS (SELECT 1 FROM case_surfaces u WHERE u.case_id ="
        " m.case_id))"}},
      {"surface_error",
       {"(SELECT u.error_of_slip FROM case_surfaces u WHERE u.case_id = m.case_id)"}},
      {"field_coverage", {"m.field_coverage"}},
      {"field_assumed", {"m.field_assumed"}},
      {"max_nucleation_ratio", {"m.max_nucleation_ratio"}},
      {"unexpected", {"(m.unexpected_episode IS NOT NULL)"}},
      {"unexpected_fault",
       {"(SELECT n.name FROM episodes e JOIN names n ON n.id = e.fault_id WHERE e.case_id ="
        " m.case_id AND e.number = m.unexpected_episode)"}},
      {"n_episodes", {"m.n_episodes"}},
      {"max_penetration", {"m.max_penetration_m"}},
      {"newton_iterations", {"m.newton_iterations"}},
      {"active_set_passes", {"m.active_set_passes"}},
      {"sub_steps", {"m.sub_steps"}},
      {"wasted_newton_iterations", {"m.wasted_newton_iterations"}},
      {"seconds", {"(SELECT wall_s FROM runs WHERE id = m.run_id)"}},
  };
  // Measures have a column of their own, of stages as of faults.
  const faultsim::Measures measures;
  faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto&) {
    columns[std::string(field.metric())] = {
        field.sql.empty() ? concat("$.", field.key) : std::string(field.sql), true};
  });
  return columns;
}

const MetricColumn& column_of(const std::string& metric) {
  static const std::map<std::string, MetricColumn> columns = all_columns();
  const auto found = columns.find(metric);
  FAULTSIM_DEMAND(found != columns.end(), metric);
  return found->second;
}

/// "$" replaced by the row, "$F" and "$O" by its faults.
std::string filled(const std::string& sql, const std::string& row, bool of_fault) {
  const std::string slides = of_fault ? "$.fault_id" : "$.activated_fault_id";
  const std::string opens = of_fault ? "$.fault_id" : "$.opened_fault_id";
  return replaced(replaced(replaced(sql, "$F", slides), "$O", opens), "$", row);
}

const std::string& sql_for(const MetricColumn& column, bool of_fault) {
  return of_fault || column.together.empty() ? column.sql : column.together;
}

// A value of a scope is a subquery: kScopeBegin VALUE kScopeFrom TABLE kScopeWhere KEYS kScopeEnd.
constexpr std::string_view kScopeBegin = "(SELECT /* of a scope */ ";
constexpr std::string_view kScopeFrom = " FROM /* its row */ ";
constexpr std::string_view kScopeWhere = " x WHERE x.stage_id = ";
constexpr std::string_view kScopeEnd = " AND x.case_id = cc.case_id)";

/// SQL over the row of a scope, as SQL of a query over cc; of no row it stays as it is.
std::string scoped(const std::string& sql, const MetricScope& scope, std::int64_t stage_of_query) {
  if (sql.find('$') == std::string::npos) return sql;
  const bool of_fault = scope.fault.has_value();
  return concat(kScopeBegin, filled(sql, "x", of_fault), kScopeFrom,
                of_fault ? "fault_metrics" : "stage_metrics", kScopeWhere,
                scope.stage.value_or(stage_of_query),
                of_fault ? concat(" AND x.fault_id = ", *scope.fault) : "", kScopeEnd);
}

// What is not resolved ----------------------------------------------------------------------------

/// On what a value depends that cells may leave open, once the history has its end.
enum class Depends {
  on_the_run,           ///< nothing where there is a result, even of a history that ended early.
  on_the_history,       ///< nothing else: taken as of these cells.
  on_activation,        ///< whether the row's fault slides; together: whether some fault does.
  on_every_activation,  ///< the same; together: whether each fault of the row slides.
  on_any_of_the_case,   ///< whether faults slide, in whatever stage.
  on_events,            ///< sizes of slip events, or whether there is one.
  on_magnitudes,        ///< the same; in plane strain there are none for certain.
  on_activation_and_events,  ///< on_every_activation and on_events.
};

/// The one table of that.
Depends dependence_of(const std::string& metric) {
  static const std::map<std::string, Depends> dependences = [] {
    std::map<std::string, Depends> all;
    const auto add = [&all](Depends on, const std::vector<const char*>& metrics) {
      for (const char* one : metrics) all.emplace(one, on);
    };
    add(Depends::on_the_run, {"outcome", "plane_strain", "interpolated", "surface_error",
                              "field_coverage", "field_assumed"});
    add(Depends::on_the_history,
        {"activation_resolved", "weakening_resolved", "slips", "opens", "open_area"});
    add(Depends::on_the_history,
        {"opening_step", "opening_depth", "opening_pressure_change", "opening_pressure_absolute",
         "opening_change_in_fault", "opened_fault"});
    add(Depends::on_the_history, {"chi_bar", "chi_max", "area_chi_080", "thickness_chi_080"});
    add(Depends::on_the_history, {"creep_normal_min", "creep_normal_max", "creep_shear_max"});
    add(Depends::on_the_history, {"creep_time_steps", "creep_time_error", "creep_time_resolved"});
    add(Depends::on_activation, {"slides"});
    add(Depends::on_every_activation,
        {"activation_step", "activation_depth", "activation_pressure_change",
         "activation_pressure_absolute", "activation_change_before", "activation_change_in_fault",
         "activated_fault"});
    add(Depends::on_any_of_the_case,
        {"unexpected", "unexpected_fault", "n_episodes", "pressure_margin"});
    add(Depends::on_events, {"jumps", "n_events", "event_moment", "event_stress_drop", "moment",
                             "max_slip", "potency", "slipping_area"});
    add(Depends::on_magnitudes, {"event_magnitude", "magnitude_if_released_at_once"});
    add(Depends::on_activation_and_events, {"activated_area"});
    return all;
  }();
  const auto found = dependences.find(metric);
  FAULTSIM_DEMAND(found != dependences.end(), metric, ": on what does it depend?");
  return found->second;
}

constexpr const char* kEarly = "coalesce(s.rank_class, 2) > 1";   // see CaseRow::complete
constexpr const char* kUnsure = ".activation_resolved IS NOT 1";  // missing: not known
constexpr const char* kEventsOpen = "(m.outcome = 'unresolved_event' OR NOT m.weakening_resolved)";

std::string list_of(const std::vector<std::int64_t>& ids) { return joined(ids, ", "); }

/// That the activation of some fault is not resolved in these stages. Faults are named one by one:
/// the key of fault_metrics has them before the case.
std::string some_unsure(const std::string& stages, const MetricIds& all) {
  return concat("EXISTS (SELECT 1 FROM fault_metrics y WHERE y.stage_id ", stages,
                " AND y.fault_id IN (", list_of(all.faults), ") AND y.case_id = cc.case_id AND y",
                kUnsure, ")");
}

/// Condition on which what a value depends on is left open; "" = never.
std::string open_sql(Depends depends, bool of_fault, const MetricIds& all) {
  const std::string own = concat("$", kUnsure);
  const std::string each =
      of_fault ? own : concat("(", own, " OR ", some_unsure("= $.stage_id", all), ")");
  switch (depends) {
    case Depends::on_the_run:
    case Depends::on_the_history:
      return "";
    case Depends::on_activation:
      return own;
    case Depends::on_every_activation:
      return each;
    case Depends::on_any_of_the_case:
      return concat("(s", kUnsure, " OR ",
                    some_unsure(concat("IN (", list_of(all.stages), ")"), all), ")");
    case Depends::on_events:
      return kEventsOpen;
    case Depends::on_magnitudes:
      return concat("(", kEventsOpen, " AND NOT m.plane_strain)");
    case Depends::on_activation_and_events:
      return concat("(", each, " OR ", kEventsOpen, ")");
  }
  FAULTSIM_DEMAND(false, static_cast<int>(depends));
  return "";
}

/// The same with the histories that ended early, or results that are missing.
std::string with_early(Depends depends, const std::string& open) {
  if (depends == Depends::on_the_run) return "m.outcome IS NULL";
  return open.empty() ? kEarly : concat(kEarly, " OR ", open);
}

/// The SQL of a value over row x, over another row.
std::string over_row(std::string_view sql, const std::string& row) {
  std::string text;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    const bool begins_word =
        i == 0 || (std::isalnum(static_cast<unsigned char>(sql[i - 1])) == 0 && sql[i - 1] != '_');
    const bool is_row = begins_word && sql.substr(i, 2) == "x.";
    text += is_row ? row : std::string(1, sql[i]);
  }
  return text;
}

}  // namespace

std::string value_of_scope(const std::string& sql, const MetricScope& scope) {
  return scoped(sql, scope, scope.stage.value());
}

bool has_stages(const std::string& metric) {
  return column_of(metric).sql.find('$') != std::string::npos;
}
bool has_faults(const std::string& metric) { return column_of(metric).of_fault; }

std::string metric_sql(const std::string& metric, bool of_fault) {
  const MetricColumn& column = column_of(metric);
  const bool one_fault = of_fault && column.of_fault;
  return filled(sql_for(column, one_fault), one_fault ? "q" : "s", one_fault);
}

std::string metric_sql(const std::string& metric, const MetricScope& scope,
                       std::int64_t stage_of_query) {
  FAULTSIM_DEMAND(has_stages(metric) && (has_faults(metric) || !scope.fault), metric);
  return scoped(sql_for(column_of(metric), scope.fault.has_value()), scope, stage_of_query);
}

std::string unresolved_sql(const std::string& metric, const MetricIds& all, bool of_fault) {
  const Depends depends = dependence_of(metric);
  const bool one_fault = of_fault && has_faults(metric);
  const std::string open = open_sql(depends, one_fault, all);
  return with_early(depends, filled(open, one_fault ? "q" : "s", one_fault));
}

std::string unresolved_sql(const std::string& metric, const MetricIds& all,
                           const MetricScope& scope, std::int64_t stage_of_query) {
  FAULTSIM_DEMAND(has_stages(metric) && (has_faults(metric) || !scope.fault), metric);
  const Depends depends = dependence_of(metric);
  const std::string open = open_sql(depends, scope.fault.has_value(), all);
  return with_early(depends, scoped(open, scope, stage_of_query));
}

std::string ScopeJoins::joined(const std::string& sql) {
  std::string text;
  std::size_t done = 0;
  for (std::size_t at = sql.find(kScopeBegin); at != std::string::npos;
       at = sql.find(kScopeBegin, done)) {
    text += sql.substr(done, at - done);
    const std::size_t value = at + kScopeBegin.size(), from = sql.find(kScopeFrom, value);
    const std::size_t end = sql.find(kScopeEnd, from);
    FAULTSIM_DEMAND(from != std::string::npos && end != std::string::npos, sql);
    done = end + kScopeEnd.size();
    const std::size_t table = from + kScopeFrom.size();
    const std::string key = sql.substr(table, done - 1 - table);  // without its bracket
    auto found = std::ranges::find(keys_, key);
    if (found == keys_.end() && keys_.size() == kMost) {
      text += sql.substr(at, done - at);
      continue;
    }
    if (found == keys_.end()) found = keys_.insert(keys_.end(), key);
    const std::string row = concat("x", found - keys_.begin());
    // A row that is not there has no value, also where its expression would make one of NULL.
    text += concat("iif(", row, ".case_id IS NULL, NULL, ",
                   over_row(std::string_view(sql).substr(value, from - value), row), ")");
  }
  return text + sql.substr(done);
}

std::string ScopeJoins::sql() const {
  std::string text;
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const std::string row = concat("x", k);
    const std::size_t where = keys_[k].find(kScopeWhere);
    text += concat(" LEFT JOIN ", keys_[k].substr(0, where), " ", row, " ON ",
                   over_row(keys_[k].substr(where + std::string_view(" x WHERE ").size()), row));
  }
  return text;
}

}  // namespace faultsweep
