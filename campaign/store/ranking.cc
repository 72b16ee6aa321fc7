#include <algorithm>

#include "campaign/common/names.h"
#include "campaign/store/queries.h"
#include "campaign/store/store.h"

namespace faultsweep {
namespace {

/// A term of an order.
struct OrderTerm {
  std::string sql;
  bool descends = false;
};
using Order = std::vector<OrderTerm>;

/// The default order is the index stage_metrics_default_order: the text must match it.
Order default_order() {
  return {{"s.rank_class"},
          {"s.activated_area_m2", true},
          {"s.open_area_m2", true},
          {"s.moment_nm", true},
          {"coalesce(s.pressure_margin_pa, 9e99)"},
          {"s.chi_bar", true},
          {"s.case_id"}};
}
/// The same of one fault, which has no margin of its own.
Order default_fault_order() {
  return {{"q.rank_class"},      {"q.activated_area_m2", true}, {"q.open_area_m2", true},
          {"q.moment_nm", true}, {"q.chi_bar", true},           {"cc.position"}};
}
Order order_of(const Store::RankingQuery& query) {
  if (query.by.text.empty()) return query.fault ? default_fault_order() : default_order();
  return {{query.fault ? "q.rank_class" : "s.rank_class"},
          {"score IS NULL"},
          {"score", !query.ascending},
          {"cc.position"}};
}

bool uses(const Store::RankingQuery& query, const char* alias) {
  return query.by.text.find(alias) != std::string::npos ||
         query.where.text.find(alias) != std::string::npos;
}

/// What the outer loop of a query goes along.
enum class Along {
  ranking,  ///< the index of the default order, which LIMIT ends early, or one fault and stage.
  cases,    ///< the campaign's, as their parameters lie: twice as fast where those of all are
            ///< read.
};
/// Of what has to look at every case.
Along along_for_all(const Store::RankingQuery& query) {
  return uses(query, "cc.") ? Along::cases : Along::ranking;
}

/// Which cases: "FROM ... WHERE ...", with the campaign, the stage and the values of `where` to be
/// bound. Only the tables that the expressions use are joined, which for 10^5 cases is what the
/// time goes into. CROSS JOIN fixes the order of the loops.
std::string selection_sql(const Store::RankingQuery& query, bool needs_dimension, Along along) {
  const char* row = query.fault ? "q" : "s";
  const char* rows = query.fault ? "fault_metrics q" : "stage_metrics s";
  const char* cases = "campaign_cases cc";
  const bool along_cases = along == Along::cases;
  std::string sql = concat(" FROM ", along_cases ? cases : rows, " CROSS JOIN ",
                           along_cases ? rows : cases, " ON cc.case_id = ", row, ".case_id");
  if (query.fault && (uses(query, "s.") || uses(query, "f."))) {
    sql += " CROSS JOIN stage_metrics s ON s.stage_id = q.stage_id AND s.case_id = q.case_id";
  }
  if (needs_dimension || uses(query, "m.")) {
    sql += concat(" CROSS JOIN case_metrics m ON m.case_id = ", row, ".case_id");
  }
  if (uses(query, "f.")) sql += " LEFT JOIN names f ON f.id = s.activated_fault_id";
  sql += concat(" WHERE cc.campaign_id = ? AND ", row,
                ".stage_id = (SELECT id FROM names WHERE name = ?)");
  if (query.fault) sql += concat(" AND q.fault_id = ", *query.fault);
  return sql + where_sql(query.where);
}

/// The cases in order: case_id, position, score.
std::string order_sql(const Store::RankingQuery& query) {
  const bool by_default = query.by.text.empty();
  const char* row = query.fault ? "q" : "s";
  std::string sql = concat(
      "SELECT ", row, ".case_id, cc.position, ", by_default ? "NULL" : "(" + query.by.text + ")",
      " AS score", selection_sql(query, false, by_default ? Along::ranking : along_for_all(query)));
  sql += " ORDER BY " + joined(order_of(query), ", ", [&](const OrderTerm& term) {
           return term.sql + (term.descends != query.from_end ? " DESC" : "");
         });
  if (query.limit == 0 && query.skip == 0) return sql;
  constexpr long kAll = -1;  // as SQLite has it
  sql += concat(" LIMIT ", query.limit > 0 ? query.limit : kAll);
  return query.skip > 0 ? sql + concat(" OFFSET ", query.skip) : sql;
}

/// Whether any case of the campaign that the query selects is plane strain, or is not.
bool has_kind(Connection& db, std::int64_t campaign, const Store::RankingQuery& query,
              bool plane_strain) {
  const char* of_kind =
      plane_strain ? " m.plane_strain = 1 LIMIT 1" : " m.plane_strain = 0 LIMIT 1";
  const auto found =
      query.where.text.empty()
          ? db.find<int>(concat("SELECT 1 FROM case_metrics m CROSS JOIN campaign_cases cc"
                                " ON cc.case_id = m.case_id AND cc.campaign_id = ? WHERE",
                                of_kind),
                         campaign)
          : db.find<int>(
                concat("SELECT 1", selection_sql(query, true, Along::ranking), " AND", of_kind),
                campaign, query.stage, query.where.parameters);
  return found.has_value();
}

/// A value of a condition, all of it.
struct Spelled {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(double number) const { return formatted("%.17g", number); }
  std::string operator()(const std::string& text) const { return text; }
};

/// All that the counts of a selection depend on but the state of the store.
std::string question_text(std::int64_t campaign, const Store::RankingQuery& query,
                          const std::string& selection) {
  std::string text = concat(campaign, "\n", query.stage, "\n", selection);
  for (const auto& value : query.where.parameters) text += "\n" + std::visit(Spelled{}, value);
  return text;
}

Store::ClassCounts count_classes(Connection& db, std::int64_t campaign,
                                 const Store::RankingQuery& query, const std::string& selection) {
  Statement count(db, concat("SELECT ", query.fault ? "q" : "s", ".rank_class, count(*)", selection,
                             " GROUP BY 1"));
  count.bind(campaign, query.stage, query.where.parameters);
  Store::ClassCounts counts = {};
  while (count.step()) {
    std::size_t rank_class = 0;
    long n = 0;
    count.read(rank_class, n);
    counts.at(rank_class) = n;
  }
  return counts;
}

}  // namespace

std::string case_sql() { return "cc.position"; }

std::string parameter_sql(int index, bool is_text) {
  return concat("(SELECT p.", is_text ? "text" : "si",
                " FROM case_parameters p WHERE p.campaign_id = cc.campaign_id"
                " AND p.position = cc.position AND p.parameter = ",
                index, ")");
}

ParameterReader::ParameterReader(Connection& connection, std::int64_t campaign)
    : campaign_(campaign),
      query_(connection.prepared("SELECT parameter, si, text FROM case_parameters"
                                 " WHERE campaign_id = ? AND position = ? ORDER BY parameter")) {}

CaseParameters ParameterReader::of(long position) {
  CaseParameters all;
  query_.bind(campaign_, position);
  while (query_.step()) {
    all.push_back(query_.row<CaseParameter, int, std::optional<double>, std::string>());
  }
  return all;
}

std::vector<RankedCase> Store::ranking(std::int64_t campaign, const RankingQuery& query) const {
  Statement order(*connection_, order_sql(query));
  order.bind(query.by.parameters, campaign, query.stage, query.where.parameters);
  std::vector<RankedCase> ranked;
  while (order.step()) {
    RankedCase& row = ranked.emplace_back();
    order.read(row.id, row.position, row.score);
  }
  if (query.from_end) std::ranges::reverse(ranked);
  const ResultTables& tables = result_tables();
  constexpr int kFirstMetric = 11;
  Statement rows = connection_->prepared(concat(
      "SELECT s.rank_class, m.outcome,"
      " m.weakening_resolved, m.pressure_margin_pa, (SELECT n.name FROM episodes e JOIN names n"
      " ON n.id = e.fault_id WHERE e.case_id = s.case_id AND e.number = m.unexpected_episode),"
      " m.plane_strain, s.stage_id, s.activated_fault_id, s.opened_fault_id,"
      " (SELECT q.rank_class FROM fault_metrics q WHERE q.stage_id = s.stage_id"
      " AND q.fault_id = ?3 AND q.case_id = s.case_id),"
      " EXISTS (SELECT 1 FROM case_surfaces u WHERE u.case_id = s.case_id)",
      tables.stage.selected("s"),
      " FROM stage_metrics s JOIN case_metrics m ON m.case_id = s.case_id"
      " WHERE s.stage_id = (SELECT id FROM names WHERE name = ?1) AND s.case_id = ?2"));
  ParameterReader parameters(*connection_, campaign);
  for (RankedCase& row : ranked) {
    FAULTSIM_DEMAND(rows.bind(query.stage, row.id, query.fault).step(), row.id);
    row.parameters = parameters.of(row.position);
    std::int64_t stage = 0;
    int fault_rank_class = 0;
    std::optional<std::int64_t> slides, opens;
    rows.read(row.rank_class, row.outcome, row.weakening_resolved, row.pressure_margin,
              row.unexpected_fault, row.plane_strain, stage, slides, opens, fault_rank_class,
              row.interpolated);
    int column = kFirstMetric;
    tables.stage.read(rows, column, row.metrics);
    const auto fault_row = [&](std::int64_t fault) {
      return read_fault_row(*connection_, tables, row.id, stage, fault);
    };
    if (query.fault) {
      row.fault_metrics = fault_row(*query.fault);
      row.rank_class = fault_rank_class;
    } else {  // the faults that slide and open first
      if (slides) row.metrics.faults.push_back(fault_row(*slides));
      if (opens && opens != slides) row.metrics.faults.push_back(fault_row(*opens));
    }
  }
  return ranked;
}

Store::ClassCounts Store::class_counts(std::int64_t campaign, const RankingQuery& query) const {
  const std::int64_t state = connection_->state();
  if (state != counted_state_) class_counts_.clear();
  counted_state_ = state;
  constexpr std::size_t kMostKept = 64;
  if (class_counts_.size() >= kMostKept) class_counts_.clear();
  const std::string selection = selection_sql(query, false, along_for_all(query));
  const std::string key = question_text(campaign, query, selection);
  auto known = class_counts_.find(key);
  if (known == class_counts_.end())
    known =
        class_counts_.emplace(key, count_classes(*connection_, campaign, query, selection)).first;
  return known->second;
}

Store::Kinds Store::kinds(std::int64_t campaign, const RankingQuery& query) const {
  Kinds kinds;
  kinds.plane_strain = has_kind(*connection_, campaign, {}, true);
  kinds.total = has_kind(*connection_, campaign, {}, false);
  if (kinds.plane_strain && kinds.total && !query.where.text.empty()) {
    kinds.plane_strain = has_kind(*connection_, campaign, query, true);
    kinds.total = has_kind(*connection_, campaign, query, false);
  }
  return kinds;
}

std::vector<NamedId> Store::stages(std::int64_t campaign) const {
  return connection_->rows<NamedId, std::int64_t, std::string>(
      "SELECT n.id, n.name FROM names n WHERE EXISTS (SELECT 1 FROM stage_metrics s"
      " CROSS JOIN campaign_cases cc ON cc.case_id = s.case_id"
      " AND cc.campaign_id = ?1 WHERE s.stage_id = n.id) ORDER BY n.id",
      campaign);
}

std::vector<NamedId> Store::faults(std::int64_t campaign) const {
  return connection_->rows<NamedId, std::int64_t, std::string>(
      "SELECT n.id, n.name FROM names n WHERE EXISTS (SELECT 1 FROM fault_metrics q"
      " CROSS JOIN campaign_cases cc ON cc.case_id = q.case_id"
      " AND cc.campaign_id = ?1 WHERE q.stage_id = (SELECT id FROM names WHERE"
      " name = '') AND q.fault_id = n.id) ORDER BY n.id",
      campaign);
}

}  // namespace faultsweep
