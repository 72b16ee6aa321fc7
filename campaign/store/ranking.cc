#include <map>

#include "campaign/store/bind_values.h"
#include "campaign/store/read_stage.h"
#include "campaign/store/sqlite.h"
#include "campaign/store/store.h"

namespace faultsweep {
namespace {

/// Metrics of spec/metrics.h (fields of StageMetrics and CaseResult) -> columns.
const std::map<std::string, std::string>& metric_columns() {
  // Creep is kept per load step only: few ask for it, and a case's steps lie together.
  const auto creep = [](const char* aggregate, const char* table) {
    return faultsim::concat("(SELECT ", aggregate, " FROM ", table, " WHERE case_id = s.case_id",
                            " AND step BETWEEN s.first_step AND s.last_step)");
  };
  static const std::map<std::string, std::string> columns = {
      {"creep_normal_min", creep("min(creep_normal_min_pa)", "chi_history")},
      {"creep_normal_max", creep("max(creep_normal_max_pa)", "chi_history")},
      {"creep_shear_max", creep("max(creep_shear_max_pa)", "chi_history")},
      {"creep_time_steps", creep("sum(time_steps)", "load_steps")},
      {"creep_time_error", creep("max(time_error_pa)", "load_steps")},
      {"creep_time_resolved", creep("min(time_resolved)", "load_steps")},
      {"outcome", "m.outcome"},
      {"rank_class", "s.rank_class"},
      {"activated", "s.activated"},
      {"activation_step", "s.activation_step"},
      {"activation_pressure", "s.activation_pressure_pa"},
      {"activated_fault", "f.name"},
      {"chi_bar", "s.chi_bar"},
      {"chi_max", "s.chi_max"},
      {"area_chi_080", "s.area_chi_080_m2"},
      {"thickness_chi_080", "s.thickness_chi_080_m"},
      {"activated_area", "s.activated_area_m2"},
      {"slipping_area", "s.slipping_area_m2"},
      {"open_area", "s.open_area_m2"},
      {"max_slip", "s.max_slip_m"},
      {"potency", "s.potency_m3"},
      {"moment", "s.moment_nm"},
      {"magnitude", "s.magnitude_mw"},
      {"n_events", "s.n_events"},
      {"event_moment", "s.event_moment_nm"},
      {"event_magnitude", "s.event_magnitude_mw"},
      {"pressure_margin", "m.pressure_margin_pa"},
      {"failed_step", "m.failed_step"},
      {"plane_strain", "m.plane_strain"},
      {"weakening_resolved", "m.weakening_resolved"},
      {"max_nucleation_ratio", "m.max_nucleation_ratio"},
      {"unexpected", "coalesce(m.unexpected, 0)"},
      {"n_episodes", "m.n_episodes"},
      {"max_penetration", "m.max_penetration_m"},
      {"newton_iterations", "m.newton_iterations"},
      {"active_set_passes", "m.active_set_passes"},
      {"sub_steps", "m.sub_steps"},
      {"wasted_newton_iterations", "m.wasted_newton_iterations"},
      {"seconds", "(SELECT wall_s FROM runs WHERE id = m.run_id)"},
  };
  return columns;
}

/// The default order is the index stage_metrics_default_order: the text must match it.
constexpr const char* kDefaultOrder =
    "s.rank_class, s.activated_area_m2 DESC, s.moment_nm DESC,"
    " coalesce(s.pressure_margin_pa, 9e99), s.chi_bar DESC, s.case_id";

}  // namespace

void bind_values(Statement& statement, int& position, const std::vector<Value>& values) {
  for (const Value& value : values) {
    ++position;
    if (const auto* number = std::get_if<double>(&value)) {
      statement.bind_at(position, *number);
    } else if (const auto* flag = std::get_if<bool>(&value)) {
      statement.bind_at(position, *flag ? 1 : 0);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      statement.bind_at(position, *text);
    } else {
      statement.bind_at(position, std::optional<double>());
    }
  }
}

std::string metric_sql(const std::string& metric) {
  const auto found = metric_columns().find(metric);
  FAULTSIM_DEMAND(found != metric_columns().end(), metric);
  return found->second;
}

std::string parameter_sql(int index) {
  return faultsim::concat("json_extract(cc.parameter_values, '$[", index, "]')");
}

namespace {

/// The cases in order: case_id, position, score. Only the tables that the expressions use are
/// joined, which for 10^5 cases is what the time goes into. CROSS JOIN fixes the order of the
/// loops: along the index of the default order, so that LIMIT stops early.
std::string order_sql(const Store::RankingQuery& query) {
  const bool by_default = query.by.text.empty();
  const std::string used = query.by.text + " " + query.where.text;
  std::string sql = faultsim::concat(
      "SELECT s.case_id, cc.position, ", by_default ? "NULL" : "(" + query.by.text + ")",
      " AS score FROM stage_metrics s"
      " CROSS JOIN campaign_cases cc ON cc.case_id = s.case_id AND cc.campaign_id = ?");
  if (used.find("m.") != std::string::npos) {
    sql += " CROSS JOIN case_metrics m ON m.case_id = s.case_id";
  }
  if (used.find("f.") != std::string::npos) {
    sql += " LEFT JOIN names f ON f.id = s.activated_fault_id";
  }
  sql += " WHERE s.stage_id = (SELECT id FROM names WHERE name = ?)";
  if (!query.where.text.empty()) sql += " AND coalesce((" + query.where.text + "), 0)";
  sql += by_default ? faultsim::concat(" ORDER BY ", kDefaultOrder)
                    : faultsim::concat(" ORDER BY s.rank_class, score IS NULL, score",
                                       query.ascending ? "" : " DESC", ", cc.position");
  return query.limit > 0 ? sql + faultsim::concat(" LIMIT ", query.limit) : sql;
}

struct OrderedCase {
  std::int64_t id;
  long position;
  std::optional<double> score;
};

}  // namespace

std::vector<RankedCase> Store::ranking(std::int64_t campaign, const RankingQuery& query) const {
  Statement order(*connection_, order_sql(query).c_str());
  int bound = 0;
  bind_values(order, bound, query.by.parameters);
  order.bind_at(++bound, campaign);
  order.bind_at(++bound, query.stage);
  bind_values(order, bound, query.where.parameters);
  std::vector<OrderedCase> cases;
  while (order.step()) {
    cases.push_back(
        {order.integer(0), static_cast<long>(order.integer(1)), order.optional_real(2)});
  }
  Statement& rows = connection_->prepared(
      "SELECT cc.parameter_values, cc.parameter_labels, s.rank_class, m.outcome,"
      " m.weakening_resolved, m.pressure_margin_pa, s.activated, s.activation_step,"
      " s.activation_pressure_pa, coalesce(f.name, ''), s.chi_bar, s.chi_max, s.area_chi_080_m2,"
      " s.thickness_chi_080_m, s.activated_area_m2, s.slipping_area_m2, s.open_area_m2, "
      "s.max_slip_m,"
      " s.potency_m3, s.moment_nm, s.magnitude_mw, s.n_events, s.event_moment_nm,"
      " s.event_magnitude_mw, s.first_step, s.last_step, coalesce(m.unexpected, 0)"
      " FROM stage_metrics s JOIN case_metrics m ON m.case_id = s.case_id"
      " JOIN campaign_cases cc ON cc.campaign_id = ?1 AND cc.position = ?2"
      " LEFT JOIN names f ON f.id = s.activated_fault_id"
      " WHERE s.stage_id = (SELECT id FROM names WHERE name = ?3) AND s.case_id = ?4");
  std::vector<RankedCase> ranked;
  ranked.reserve(cases.size());
  for (const OrderedCase& one : cases) {
    FAULTSIM_DEMAND(rows.bind(campaign, one.position, query.stage, one.id).step(), one.id);
    RankedCase row;
    row.id = one.id;
    row.position = one.position;
    row.score = one.score;
    row.parameter_values = rows.text(0);
    row.parameter_labels = rows.text(1);
    row.rank_class = static_cast<int>(rows.integer(2));
    row.outcome = rows.text(3);
    row.weakening_resolved = rows.integer(4) != 0;
    row.pressure_margin = rows.optional_real(5);
    row.metrics = read_stage_metrics(rows, 6);
    row.metrics.stage = query.stage;
    row.unexpected = rows.integer(26) != 0;
    ranked.push_back(std::move(row));
  }
  rows.reset();
  return ranked;
}

std::vector<std::string> Store::stages(std::int64_t campaign) const {
  std::vector<std::string> names;
  Statement& query = connection_->prepared(
      "SELECT n.name FROM names n WHERE EXISTS (SELECT 1 FROM campaign_cases cc JOIN stage_metrics "
      "s"
      " ON s.stage_id = n.id AND s.case_id = cc.case_id WHERE cc.campaign_id = ?) ORDER BY n.id");
  query.bind(campaign);
  while (query.step()) names.push_back(query.text(0));
  return names;
}

}  // namespace faultsweep
