#include <algorithm>
#include <charconv>
#include <tuple>
#include <utility>

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

bool uses(const Store::RankingQuery& query, const char* alias) {
  return query.by.text.find(alias) != std::string::npos ||
         query.where.text.find(alias) != std::string::npos;
}

/// A query with the tables of parameters that it joins instead of looking them up for each row,
/// which takes half as long again.
struct Joined {
  Store::RankingQuery query;
  std::vector<int> parameters = {};  ///< as tables p0, p1, …
};

/// Puts the column of the joined table in the place of each look-up of the parameter.
bool join_parameter(int index, bool is_text, std::string& text) {
  const std::string look_up = parameter_sql(index, is_text);
  const std::string column = concat("p", index, is_text ? ".text" : ".si");
  bool is_used = false;
  for (std::size_t at = text.find(look_up); at != std::string::npos; at = text.find(look_up, at)) {
    text.replace(at, look_up.size(), column);
    is_used = true;
  }
  return is_used;
}

Joined join_parameters(const Store::RankingQuery& query) {
  constexpr int kMost = 48;  // SQLite joins 64 tables at most; the others are looked up
  Joined joined{query};
  for (int k = 0; k < kMost; ++k) {
    bool is_used = false;
    for (std::string* text : {&joined.query.by.text, &joined.query.where.text}) {
      for (const bool is_text : {false, true}) is_used |= join_parameter(k, is_text, *text);
    }
    if (is_used) joined.parameters.push_back(k);
  }
  return joined;
}

/// What the outer loop of a query goes along.
enum class Along {
  ranking,  ///< the index of the default order, which LIMIT ends early, or one fault and stage.
  cases,    ///< the campaign's, by position: of what has to look at every case.
};

/// Which cases: "FROM ... WHERE ...", with the campaign, the stage and the values of `where` to be
/// bound. Only the tables that the expressions use are joined, which for 10^5 cases is what the
/// time goes into. CROSS JOIN fixes the order of the loops.
std::string selection_sql(const Store::RankingQuery& asked, bool needs_dimension, Along along) {
  const Joined joined = join_parameters(asked);
  const Store::RankingQuery& query = joined.query;
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
  for (const int k : joined.parameters) {
    sql += concat(" LEFT JOIN case_parameters p", k, " ON p", k, ".campaign_id = cc.campaign_id",
                  " AND p", k, ".position = cc.position AND p", k, ".parameter = ", k);
  }
  sql += concat(" WHERE cc.campaign_id = ? AND ", row,
                ".stage_id = (SELECT id FROM names WHERE name = ?)");
  if (query.fault) sql += concat(" AND q.fault_id = ", *query.fault);
  return sql + where_sql(query.where);
}

/// The cases in the default order: case_id, position.
std::string default_order_sql(const Store::RankingQuery& query) {
  const Order order = query.fault ? default_fault_order() : default_order();
  std::string sql = concat("SELECT ", query.fault ? "q" : "s", ".case_id, cc.position",
                           selection_sql(query, false, Along::ranking));
  sql += " ORDER BY " + joined(order, ", ", [&](const OrderTerm& term) {
           return term.sql + (term.descends != query.from_end ? " DESC" : "");
         });
  if (query.limit == 0 && query.skip == 0) return sql;
  constexpr long kAll = -1;  // as SQLite has it
  sql += concat(" LIMIT ", query.limit > 0 ? query.limit : kAll);
  return query.skip > 0 ? sql + concat(" OFFSET ", query.skip) : sql;
}

/// Whether a query asks for all results of a campaign.
bool selects_all(const Store::RankingQuery& query) {
  return query.where.text.empty() && query.stage.empty() && !query.fault;
}

/// Whether any case of the campaign that the query selects is plane strain, or is not.
bool has_kind(Connection& db, std::int64_t campaign, const Store::RankingQuery& query,
              bool plane_strain) {
  const char* of_kind =
      plane_strain ? " m.plane_strain = 1 LIMIT 1" : " m.plane_strain = 0 LIMIT 1";
  const auto found =
      selects_all(query)
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

/// All that an answer depends on but the state of the store.
std::string question_text(std::int64_t campaign, const Store::RankingQuery& query,
                          const std::string& sql) {
  std::string text = concat(campaign, "\n", query.stage, "\n", sql);
  for (const SqlFragment* part : {&query.by, &query.where}) {
    for (const auto& value : part->parameters) text += "\n" + std::visit(Spelled{}, value);
  }
  return text;
}

/// A score and whose it is: by position in the campaign or by case_id.
using Score = std::pair<std::int64_t, std::optional<double>>;

/// Scores in ascending order of their key.
struct Scores {
  bool by_position = false;
  std::vector<Score> values;
};

/// The number of the parameter, where a score is one and nothing else.
std::optional<int> only_parameter(const std::string& score) {
  const auto begin = score.rfind(' ') + 1;
  int index = 0;
  const auto end = std::from_chars(score.data() + begin, score.data() + score.size(), index).ptr;
  if (end == score.data() + begin || score != parameter_sql(index, false)) return {};
  return index;
}

/// Whether a score reads the rows of its stage, or of its stage and fault, and no other table.
bool is_of_rows(const Store::RankingQuery& query) {
  const auto reads = [&](const char* alias) {
    return query.by.text.find(alias) != std::string::npos;
  };
  return !reads("SELECT") && !reads("cc.") && !reads("m.") && !reads("f.") &&
         !(query.fault && reads("s."));
}

/// One table read from end to end takes a quarter of the time of a join that looks up each row.
Scores read_scores(Connection& db, std::int64_t campaign, const Store::RankingQuery& query,
                   std::int64_t first_case, std::int64_t last_case) {
  if (const auto parameter = only_parameter(query.by.text)) {
    return {true, db.rows<Score, std::int64_t, std::optional<double>>(
                      "SELECT position, si FROM case_parameters WHERE campaign_id = ?"
                      " AND parameter = ? ORDER BY position",
                      campaign, *parameter)};
  }
  if (is_of_rows(query)) {
    const std::string fault = query.fault ? concat(" AND q.fault_id = ", *query.fault) : "";
    const char* row = query.fault ? "q" : "s";
    return {false, db.rows<Score, std::int64_t, std::optional<double>>(
                       concat("SELECT ", row, ".case_id, (", query.by.text, ") FROM ",
                              query.fault ? "fault_metrics q" : "stage_metrics s", " WHERE ", row,
                              ".stage_id = (SELECT id FROM names WHERE name = ?)", fault, " AND ",
                              row, ".case_id BETWEEN ? AND ? ORDER BY ", row, ".case_id"),
                       query.by.parameters, query.stage, first_case, last_case)};
  }
  Scores scores{true, db.rows<Score, std::int64_t, std::optional<double>>(
                          concat("SELECT cc.position, (", join_parameters(query).query.by.text, ")",
                                 selection_sql(query, false, Along::cases)),
                          query.by.parameters, campaign, query.stage, query.where.parameters)};
  std::ranges::sort(scores.values, {}, &Score::first);
  return scores;
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

std::vector<RankedCase> Store::first_ranked(std::int64_t campaign,
                                            const RankingQuery& query) const {
  std::vector<RankedCase> ranked;
  const auto take = [&](const RankedPlace& place) {
    RankedCase& row = ranked.emplace_back();
    row.id = place.id;
    row.position = place.position;
    row.score = place.score;
  };
  if (query.by.text.empty()) {
    Statement order(*connection_, default_order_sql(query));
    order.bind(campaign, query.stage, query.where.parameters);
    while (order.step()) take(order.row<RankedPlace, std::int64_t, long>());
    if (query.from_end) std::ranges::reverse(ranked);
    return ranked;
  }
  const std::vector<RankedPlace>& all = order_by_score(campaign, query);
  const std::size_t n = all.size(), skipped = std::min(static_cast<std::size_t>(query.skip), n);
  const std::size_t most = query.limit > 0 ? static_cast<std::size_t>(query.limit) : n;
  const std::size_t shown = std::min(most, n - skipped);
  const std::size_t first = query.from_end ? n - skipped - shown : skipped;
  for (std::size_t k = first; k < first + shown; ++k) take(all[k]);
  return ranked;
}

const std::vector<Store::RankedPlace>& Store::selected(std::int64_t campaign,
                                                       const RankingQuery& asked) const {
  forget_if_changed();
  RankingQuery query = asked;
  query.by = {};  // the same whatever they are ordered by
  const char* row = query.fault ? "q" : "s";
  const std::string sql = concat("SELECT ", row, ".case_id, cc.position, ", row, ".rank_class",
                                 selection_sql(query, false, Along::cases));
  const std::string key = question_text(campaign, query, sql);
  if (const auto known = std::ranges::find(selected_, key, &KeptPlaces::key);
      known != selected_.end())
    return known->places;
  std::vector<RankedPlace> places = connection_->rows<RankedPlace, std::int64_t, long, int>(
      sql, campaign, query.stage, query.where.parameters);
  std::ranges::sort(places, {}, &RankedPlace::position);
  if (selected_.size() >= kMostKept) selected_.pop_front();
  selected_.push_back({key, std::move(places)});
  return selected_.back().places;
}

/// All pages of an order are one sort, which is kept until the store changes; the other way round
/// it is another sort of what was read.
const std::vector<Store::RankedPlace>& Store::order_by_score(std::int64_t campaign,
                                                             const RankingQuery& query) const {
  forget_if_changed();
  std::string key =
      question_text(campaign, query, query.by.text + selection_sql(query, false, Along::cases));
  auto known = std::ranges::find(orders_, key, &KeptPlaces::key);
  if (known == orders_.end()) {
    KeptPlaces order{std::move(key), selected(campaign, query)};
    score(campaign, query, order.places);
    if (orders_.size() >= kMostKept) orders_.pop_front();
    orders_.push_back(std::move(order));
    known = std::prev(orders_.end());
  }
  if (known->ascending == query.ascending) return known->places;
  const auto key_of = [&](const RankedPlace& place) {
    const double score = place.score.value_or(0);
    return std::tuple(place.rank_class, !place.score, query.ascending ? score : -score,
                      place.position);
  };
  std::ranges::sort(known->places, {}, key_of);
  known->ascending = query.ascending;
  return known->places;
}

void Store::score(std::int64_t campaign, const RankingQuery& query,
                  std::vector<RankedPlace>& places) const {
  if (places.empty()) return;
  const auto [first, last] = std::ranges::minmax_element(places, {}, &RankedPlace::id);
  const Scores scores = read_scores(*connection_, campaign, query, first->id, last->id);
  auto next = scores.values.begin();
  for (RankedPlace& place : places) {
    const std::int64_t key = scores.by_position ? place.position : place.id;
    if (next == scores.values.end() || next->first != key)
      next = std::ranges::lower_bound(scores.values, key, {}, &Score::first);
    if (next != scores.values.end() && next->first == key) place.score = (next++)->second;
  }
}

std::vector<RankedCase> Store::ranking(std::int64_t campaign, const RankingQuery& query) const {
  std::vector<RankedCase> ranked = first_ranked(campaign, query);
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

void Store::forget_if_changed() const {
  const std::int64_t state = connection_->state();
  if (state != counted_state_) {
    selected_.clear();
    orders_.clear();
  }
  counted_state_ = state;
}

Store::ClassCounts Store::class_counts(std::int64_t campaign, const RankingQuery& query) const {
  ClassCounts counts = {};
  for (const RankedPlace& place : selected(campaign, query)) ++counts.at(place.rank_class);
  return counts;
}

Store::Kinds Store::kinds(std::int64_t campaign, const RankingQuery& query) const {
  Kinds kinds;
  kinds.plane_strain = has_kind(*connection_, campaign, {}, true);
  kinds.total = has_kind(*connection_, campaign, {}, false);
  if (kinds.mixed() && !selects_all(query)) {
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
