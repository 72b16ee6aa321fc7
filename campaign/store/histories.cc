#include <map>
#include <utility>

#include "campaign/common/names.h"
#include "campaign/store/queries.h"
#include "simulator/result/result_fields.h"

/// What faults did, load step by load step.
namespace faultsweep {

namespace {

struct HistoryColumn {
  std::string name, sql;
};

/// Joined as in the view chi_history_wide.
std::vector<HistoryColumn> history_fields() {
  std::vector<HistoryColumn> all = {
      {"case", "cc.position"}, {"fault", "hf.name"},
      {"step", "h.step"},      {"stage", "g.name"},
      {"time_s", "l.time_s"},  {"pressure_change_pa", "l.pressure_change_pa"},
      {"outcome", "l.outcome"}};
  const auto add = [&all](const std::string& row, std::string_view prefix = "") {
    return [&all, row, prefix](const faultsim::Field& field, const auto&) {
      const std::string name = concat(prefix, field.key);
      if (field.key != "faults") all.push_back({name, row + name});
    };
  };
  const faultsim::FaultMetrics metrics;
  const faultsim::FaultCreep fault_creep;
  const faultsim::StepCreep step_creep;
  faultsim::for_each_field(metrics, add("h."));
  all.push_back({"newton_iterations", "l.newton_iterations"});
  faultsim::for_each_field(fault_creep, add("h.", "creep_"));
  faultsim::for_each_field(step_creep, add("l."));
  return all;
}

/// Each column of history_fields() as SQL under its name; of mixed results what is per metre apart.
std::vector<std::pair<std::string, std::string>> columns_of(Store::Kinds kinds) {
  std::vector<std::pair<std::string, std::string>> columns;
  for (const auto& [name, sql] : history_fields()) {
    if (!faultsim::is_extensive(name) || !kinds.plane_strain) {
      columns.emplace_back(name, sql);
    } else if (!kinds.total) {
      columns.emplace_back(name + "_per_m", sql);
    } else {
      columns.emplace_back(name, concat("iif(m.plane_strain, NULL, ", sql, ")"));
      columns.emplace_back(name + "_per_m", concat("iif(m.plane_strain, ", sql, ", NULL)"));
    }
  }
  return columns;
}

/// The column of the histories that has a metric of faults, by its name in metric_catalogue().
std::map<std::string, std::string> kept_metrics() {
  std::map<std::string, std::string> columns = {{"thickness_chi_080", "thickness_chi_080_max_m"}};
  const faultsim::Measures measures;
  const faultsim::FaultMetrics step;
  faultsim::for_each_field(step, [&](const faultsim::Field& kept, const auto&) {
    faultsim::for_each_measure(measures, [&](const faultsim::Field& measure, const auto&) {
      if (measure.key == kept.key) columns.emplace(measure.metric(), kept.key);
    });
  });
  return columns;
}

}  // namespace

std::vector<std::string> Store::history_columns(Kinds kinds) {
  std::vector<std::string> names;
  for (const auto& [name, sql] : columns_of(kinds)) names.push_back(name);
  return names;
}

void Store::for_each_history_row(std::int64_t campaign, const TableQuery& query, Kinds kinds,
                                 const std::function<void(const std::vector<Cell>&)>& visit) const {
  std::string sql;
  const auto columns = columns_of(kinds);
  for (const auto& [name, column] : columns) sql += (sql.empty() ? "SELECT " : ", ") + column;
  sql += concat(" FROM campaign_cases cc", joins(query),
                " CROSS JOIN chi_history h ON h.case_id = cc.case_id"
                " CROSS JOIN load_steps l ON l.case_id = h.case_id AND l.step = h.step"
                " CROSS JOIN names g ON g.id = l.stage_id CROSS JOIN names hf ON hf.id = h.fault_id"
                " WHERE cc.campaign_id = ?",
                query.stage.empty() ? "" : " AND h.step BETWEEN s.first_step AND s.last_step",
                query.fault ? concat(" AND h.fault_id = ", *query.fault) : "",
                where_sql(query.where), " ORDER BY cc.position, h.fault, h.step");
  Statement rows(*connection_, sql);
  rows.bind(query.stage, campaign, query.where.parameters);
  std::vector<Cell> cells(columns.size());
  while (rows.step()) {
    for (std::size_t k = 0; k < cells.size(); ++k) cells[k] = rows.cell(static_cast<int>(k));
    visit(cells);
  }
}

std::vector<std::string> history_metrics() {
  std::vector<std::string> names;
  for (const auto& [name, column] : kept_metrics()) names.push_back(name);
  return names;
}

std::string history_sql(const std::string& metric, std::int64_t fault, std::int64_t whole_history,
                        int step) {
  static const std::map<std::string, std::string> columns = kept_metrics();
  const auto found = columns.find(metric);
  FAULTSIM_DEMAND(found != columns.end(), metric);
  // The key of the table has the fault's place in the case's list.
  return concat("(SELECT h.", found->second, " FROM chi_history h WHERE h.case_id = cc.case_id",
                " AND h.fault = ", value_of_scope("$.fault", {fault, whole_history}),
                " AND h.step = ", step, ")");
}

std::string stage_pressure_sql(std::size_t region, bool largest) {
  return concat("(SELECT ", largest ? "max" : "min", "(json_extract(l.pressure_change_pa, '$[",
                region, "]')) FROM load_steps l WHERE l.case_id = cc.case_id",
                " AND l.step BETWEEN s.first_step - 1 AND s.last_step)");
}

std::vector<Store::LoadStep> Store::load_steps(std::int64_t campaign,
                                               const TableQuery& query) const {
  return connection_->rows<LoadStep, int, std::string, double, double, long>(
      concat("SELECT l.step, g.name, min(l.time_s), max(l.time_s), count(*)"
             " FROM campaign_cases cc",
             joins(query),
             " CROSS JOIN load_steps l ON l.case_id = cc.case_id"
             " CROSS JOIN names g ON g.id = l.stage_id"
             " WHERE cc.campaign_id = ? AND s.rank_class < 2",
             query.stage.empty() ? "" : " AND l.step BETWEEN s.first_step AND s.last_step",
             where_sql(query.where), " GROUP BY l.step, l.stage_id ORDER BY 1, 2"),
      query.stage, campaign, query.where.parameters);
}

}  // namespace faultsweep
