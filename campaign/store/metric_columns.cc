#include <map>

#include "campaign/store/store.h"
#include "simulator/result/measures.h"

/// Metrics of spec/metrics.h as SQL.
namespace faultsweep {
namespace {

using faultsim::concat;

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

/// Measures have a column of their own, of stages as of faults.
void add_measures(std::map<std::string, MetricColumn>& columns) {
  const faultsim::Measures measures;
  faultsim::for_each_measure(measures, [&](const faultsim::Field& field, const auto&) {
    columns[std::string(field.metric())] = {
        field.sql.empty() ? concat("$.", field.key) : std::string(field.sql), true};
  });
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
  add_measures(columns);
  return columns;
}

const MetricColumn& column_of(const std::string& metric) {
  static const std::map<std::string, MetricColumn> columns = all_columns();
  const auto found = columns.find(metric);
  FAULTSIM_DEMAND(found != columns.end(), metric);
  return found->second;
}

std::string filled(const MetricColumn& column, const std::string& row, bool of_fault) {
  const std::string& sql = of_fault || column.together.empty() ? column.sql : column.together;
  std::string text;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    if (sql[i] != '$') {
      text += sql[i];
    } else if (i + 1 < sql.size() && (sql[i + 1] == 'F' || sql[i + 1] == 'O')) {
      const char* first = sql[++i] == 'F' ? ".activated_fault_id" : ".opened_fault_id";
      text += row + (of_fault ? ".fault_id" : first);
    } else {
      text += row;
    }
  }
  return text;
}

}  // namespace

bool has_stages(const std::string& metric) {
  return column_of(metric).sql.find('$') != std::string::npos;
}
bool has_faults(const std::string& metric) { return column_of(metric).of_fault; }

std::string metric_sql(const std::string& metric, bool of_fault) {
  const MetricColumn& column = column_of(metric);
  const bool one_fault = of_fault && column.of_fault;
  return filled(column, one_fault ? "q" : "s", one_fault);
}

std::string metric_sql(const std::string& metric, const MetricScope& scope,
                       std::int64_t stage_of_query) {
  const MetricColumn& column = column_of(metric);
  FAULTSIM_DEMAND(has_stages(metric) && (has_faults(metric) || !scope.fault), metric);
  const bool of_fault = scope.fault.has_value();
  return concat("(SELECT ", filled(column, "x", of_fault), " FROM ",
                of_fault ? "fault_metrics" : "stage_metrics",
                " x WHERE x.stage_id = ", scope.stage.value_or(stage_of_query),
                of_fault ? concat(" AND x.fault_id = ", *scope.fault) : "",
                " AND x.case_id = cc.case_id)");
}

}  // namespace faultsweep
