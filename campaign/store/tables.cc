#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "campaign/common/names.h"
#include "campaign/store/queries.h"
#include "campaign/store/sqlite.h"

namespace faultsweep {

namespace {

/// CROSS JOIN fixes the order of the loops, so that rows come in the order of their keys and
/// nothing is sorted.
constexpr const char* kJoins =
    " CROSS JOIN cases c ON c.id = cc.case_id"
    " LEFT JOIN runs r ON r.id = c.run_id"
    " LEFT JOIN case_metrics m ON m.case_id = cc.case_id"
    " LEFT JOIN stage_metrics s ON s.case_id = cc.case_id"
    " AND s.stage_id = (SELECT id FROM names WHERE name = ?)"
    " LEFT JOIN names f ON f.id = s.activated_fault_id";

CaseRow read_case(const Statement& row, std::size_t n_metrics) {
  constexpr int kFirstMetric = 8;
  CaseRow one;
  row.read(one.id, one.position, one.identity, one.state, one.outcome, one.status, one.reason,
           one.rank_class);
  one.metrics.reserve(n_metrics);
  for (std::size_t k = 0; k < n_metrics; ++k) {
    one.metrics.push_back(row.cell(kFirstMetric + static_cast<int>(k)));
  }
  return one;
}

/// @param from  what gives cc.
/// @param campaign_column  of it.
void visit_cases(Connection& db, const std::string& from, const char* campaign_column,
                 std::int64_t campaign, const Store::TableQuery& query, const char* order,
                 const std::function<void(const CaseRow&)>& visit) {
  ScopeJoins scopes;
  std::string columns =
      "SELECT cc.case_id, cc.position, c.identity, c.state, coalesce(m.outcome, ''),"
      " coalesce(r.status, ''), coalesce(m.reason, r.reason, ''), s.rank_class";
  for (const SqlFragment& column : query.columns)
    columns += concat(", (", scopes.joined(column.text), ")");
  const std::string where = scopes.joined(where_sql(query.where));
  Statement rows(db, concat(columns, from, joins(query), scopes.sql(), " WHERE ", campaign_column,
                            " = ?", where, order));
  for (const SqlFragment& column : query.columns) rows.append(column.parameters);
  rows.append(query.stage, campaign, query.where.parameters);
  ParameterReader parameters(db, campaign);
  while (rows.step()) {
    CaseRow one = read_case(rows, query.columns.size());
    one.parameters = parameters.of(one.position);
    visit(one);
  }
}

/// Δp of the side that changed more, or of the fault's fluid where no region touches the place.
std::string leading_change_sql(const std::string& row) {
  const std::string minus = row + ".change_minus_pa", plus = row + ".change_plus_pa";
  return concat("coalesce(CASE WHEN coalesce(abs(", plus, ") > coalesce(abs(", minus,
                "), -1), 0) THEN ", plus, " ELSE ", minus, " END, ", row, ".change_in_fault_pa)");
}

/// Of a load step l behind step b, the time of a load factor; where that is NULL, of step
/// `else_of`.
std::string time_in_step_sql(const std::string& factor, const std::string& else_of) {
  return concat("coalesce(b.time_s + ", factor, " * (l.time_s - b.time_s), ", else_of, ".time_s)");
}

/// What the region that changes by `change` in a step had changed by in the one before; NaN where
/// no region does, as that of a place need not.
double change_before(double change, const std::string& then, const std::string& before) {
  const std::vector<double> now = numbers_of(then), earlier = numbers_of(before);
  for (std::size_t region = 0; region < std::min(now.size(), earlier.size()); ++region)
    if (now[region] == change) return earlier[region];
  return std::numeric_limits<double>::quiet_NaN();
}

/// "1 5": numbers with blanks between them.
std::vector<std::int64_t> ids_of(const std::string& text) {
  std::vector<std::int64_t> ids;
  std::istringstream stream(text);
  for (std::int64_t id = 0; stream >> id;) ids.push_back(id);
  return ids;
}

/// Of a stage's row s: the faults that are not resolved there, or NULL.
/// @param faults  ids; fault_metrics is looked up by stage, fault and case.
std::string unresolved_faults_sql(const std::vector<NamedId>& faults) {
  std::string list = joined(faults, ", ", &NamedId::id);
  return concat(
      "iif(s.rank_class = 1, (SELECT group_concat(q.fault_id, ' ') FROM fault_metrics q"
      " WHERE q.stage_id = s.stage_id AND q.fault_id IN (",
      list, ") AND q.case_id = cc.case_id AND coalesce(q.activation_resolved, 0) = 0), NULL)");
}

}  // namespace

std::string joins(const Store::TableQuery& query) {
  if (!query.fault) return kJoins;
  return concat(kJoins, " LEFT JOIN fault_metrics q ON q.stage_id = s.stage_id AND q.fault_id = ",
                *query.fault, " AND q.case_id = cc.case_id");
}

std::string where_sql(const SqlFragment& where) {
  return where.text.empty() ? "" : " AND coalesce((" + where.text + "), 0)";
}

void Store::for_each_case(std::int64_t campaign, const TableQuery& query,
                          const std::function<void(const CaseRow&)>& visit) const {
  Connection& db = *connection_;
  const bool has_rows = db.row<bool>(  // else the rows of its designs are its cases
      "SELECT EXISTS (SELECT 1 FROM design_rows WHERE campaign_id = ?)", campaign);
  if (query.by_design_row && has_rows) {
    visit_cases(db,
                " FROM design_rows d CROSS JOIN campaign_cases cc"
                " ON cc.campaign_id = d.campaign_id AND cc.position = d.position",
                "d.campaign_id", campaign, query, " ORDER BY d.design, d.row", visit);
  } else {
    visit_cases(db, " FROM campaign_cases cc", "cc.campaign_id", campaign, query,
                " ORDER BY cc.position", visit);
  }
}

void Store::for_each_slip_event(std::int64_t campaign, const TableQuery& query,
                                const std::function<void(const SeenEvent&)>& visit) const {
  const std::string sql =
      concat("SELECT cc.position, coalesce(e.fault_id, 0), e.time_s, ", leading_change_sql("e"),
             ", e.magnitude_mw FROM campaign_cases cc", joins(query),
             " CROSS JOIN slip_events e ON e.case_id = cc.case_id WHERE cc.campaign_id = ?",
             where_sql(query.where), " ORDER BY cc.position, e.number");
  Statement rows(*connection_, sql);
  rows.bind(query.stage, campaign, query.where.parameters);
  while (rows.step()) {
    visit(rows.row<SeenEvent, long, std::int64_t, double, double, std::optional<double>>());
  }
}

void Store::for_each_onset(std::int64_t campaign, const TableQuery& query,
                           const std::function<void(const CaseOnsets&)>& visit) const {
  const std::string sql = concat(
      "SELECT cc.position, s.rank_class, coalesce(s.last_step, 0), coalesce(e.time_s, 0),"
      " o.fault_id, o.step, ",
      time_in_step_sql("o.load_factor_after", "l"), ", ", leading_change_sql("o"), ", ",
      time_in_step_sql("o.load_factor_before", "b"),
      ", l.pressure_change_pa, b.pressure_change_pa, ", unresolved_faults_sql(faults(campaign)),
      ", o.change_before_pa FROM campaign_cases cc", joins(query),
      " LEFT JOIN load_steps e ON s.rank_class > 1 AND e.case_id = cc.case_id"
      " AND e.step = s.last_step"
      " LEFT JOIN fault_onsets o ON o.case_id = cc.case_id AND o.stage_id = s.stage_id"
      " AND o.opening = 0"
      " LEFT JOIN load_steps l ON l.case_id = o.case_id AND l.step = o.step"
      " LEFT JOIN load_steps b ON b.case_id = o.case_id AND b.step = o.step - 1"
      " WHERE cc.campaign_id = ?",
      where_sql(query.where), " ORDER BY cc.position");
  Statement rows(*connection_, sql);
  rows.bind(query.stage, campaign, query.where.parameters);
  CaseOnsets one;
  while (rows.step()) {
    if (const long position = rows.integer(0); position != one.position) {
      if (one.position > 0) visit(one);
      one = {position,
             rows.get<std::optional<int>>(1),
             rows.get<int>(2),
             rows.real(3),
             {},
             ids_of(rows.text(11))};
    }
    if (const auto fault = rows.get<std::optional<std::int64_t>>(4)) {
      const double change = rows.real(7);
      one.onsets.push_back({*fault, rows.get<int>(5), rows.real(6), change, rows.real(8),
                            rows.get<std::optional<double>>(12).value_or(
                                change_before(change, rows.text(9), rows.text(10)))});
    }
  }
  if (one.position > 0) visit(one);
}

}  // namespace faultsweep
