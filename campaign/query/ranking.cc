#include "campaign/query/ranking.h"

#include <algorithm>
#include <numeric>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/table_output.h"
#include "campaign/spec/metrics.h"
#include "simulator/scene/tiers.h"

namespace faultsweep {

namespace {

/// Whether parameters of a group change the tier or the sizes of cells.
bool varies_cells(json group) {
  group.erase("scene");
  group.erase("set");  // is in the scene
  const std::string text = group.dump();
  return text.find("\"/tier") != std::string::npos || text.find("\"/mesh") != std::string::npos;
}

constexpr const char* kDefaultMetric = "activated_area";

Expression parse_number(const std::string& text, const CampaignInfo& campaign,
                        const Selection& selection) {
  Expression expression =
      Expression::parse(text, result_symbols(campaign, selection), scopes_of(selection));
  if (expression.type().kind == Kind::text) {
    throw InputError("--by", concat("'", text, "' is a word, not a number"),
                     "rank by a metric from --list-metrics");
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

/// Counting reads a row of each case, which for more takes longer than a ranking may.
constexpr long kMostCounted = 20000;

long number_of_cases(const Store& store, const CampaignInfo& campaign) {
  long n = 0;
  for (const RoundRecord& round : store.rounds(campaign.id)) n += round.n_cases;
  return n;
}

/// Of all cases that the query selects.
SlidingCounts count_sliding(const Store& store, const CampaignInfo& campaign,
                            const Store::RankingQuery& query) {
  const bool of_fault = query.fault.has_value();
  Store::TableQuery table;
  table.stage = query.stage;
  table.fault = query.fault;
  table.where = query.where;
  for (const char* flag : {"slides", "activation_resolved"})
    table.columns.push_back({metric_sql(flag, of_fault), {}});
  SlidingCounts counts;
  store.for_each_case(campaign.id, table, [&](const CaseRow& row) {
    if (!row.rank_class) return;
    counts.add(number_of(row.metrics[0]) > 0, number_of(row.metrics[1]) > 0);
  });
  return counts;
}

SlidingCounts count_rows(const std::vector<RankedCase>& rows) {
  SlidingCounts counts;
  for (const RankedCase& row : rows) {
    const faultsim::StageMetrics m = metrics_of(row);
    counts.add(m.activated, m.activation_resolved);
  }
  return counts;
}

/// The rows asked for. What is skipped is read: of the second half from the end.
std::vector<RankedCase> page_of(const Store& store, const CampaignInfo& campaign,
                                const Ranking& ranking, Store::RankingQuery query) {
  query.skip = ranking.request.skip.value_or(0);
  if (query.skip == 0) return store.ranking(campaign.id, query);
  const long n_left = ranking.n_all() - query.skip;
  if (n_left <= 0) return {};
  if (query.limit == 0 || query.limit > n_left) query.limit = n_left;
  if (n_left < query.skip) {
    query.from_end = true;
    query.skip = n_left - query.limit;
  }
  return store.ranking(campaign.id, query);
}

ShownUnit unit_of_scores(const std::string& by, const Store::Kinds& kinds,
                         const Selection& selection) {
  const auto known = known_metrics(selection);
  const auto found = known.find(by);
  if (found == known.end() || found->second.is_flag) return plain();
  const bool per_metre = kinds.plane_strain && !kinds.total && found->second.is_extensive();
  return shown_unit(found->second.dimension, per_metre);
}

/// What the store is asked; what is known of it before it answers goes into `ranking`.
Store::RankingQuery ranking_query(const Store& store, const CampaignInfo& campaign,
                                  RankRequest request, Ranking& ranking) {
  const bool own_choice = request.by.empty();
  if (own_choice) request.by = campaign.rank_by.empty() ? kDefaultMetric : campaign.rank_by;
  const Selection selection = make_selection(store, campaign, request.stage, request.fault);
  Store::RankingQuery query;
  ranking.campaign = campaign;
  ranking.request = request;
  ranking.by_default = request.by == kDefaultMetric && !request.ascending;
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
  ranking.extensive = extensive;
  ranking.by_unit = unit_of_scores(request.by, ranking.kinds, selection);
  return query;
}

}  // namespace

std::vector<std::int64_t> cases_ranked_first(const Store& store, const CampaignInfo& campaign,
                                             long n) {
  Ranking ranking;
  RankRequest request;
  request.top = n;
  return mapped(store.ranking(campaign.id, ranking_query(store, campaign, request, ranking)),
                &RankedCase::id);
}

Ranking make_ranking(const Store& store, const CampaignInfo& campaign, const RankRequest& request) {
  Ranking ranking;
  const Store::RankingQuery query = ranking_query(store, campaign, request, ranking);
  if (request.skip) ranking.n_rows = store.class_counts(campaign.id, query);
  ranking.rows = page_of(store, campaign, ranking, query);
  const bool all = request.skip.value_or(0) == 0 &&
                   (request.top == 0 || static_cast<long>(ranking.rows.size()) < request.top);
  if (all || number_of_cases(store, campaign) <= kMostCounted)
    ranking.counts = all ? count_rows(ranking.rows) : count_sliding(store, campaign, query);
  const bool has_field = has_flow_field(store.spec_copies(campaign.id).resolved);
  ranking.pressures =
      region_pressures(has_field, has_field ? store.oldest_numerics(campaign.id) : 0);
  ranking.approximation = approximation_note(store, campaign);
  if (request.stage.empty() && request.fault.empty())
    ranking.error_bars = error_bars_of(store, campaign);
  return ranking;
}

long Ranking::n_all() const { return std::reduce(n_rows.begin(), n_rows.end()); }

std::vector<std::string> tier_names() {
  return faultsim::mapped(faultsim::tiers(),
                          [](const faultsim::Tier& tier) { return std::string(tier.name); });
}

std::string common_tier(const Store& store, const CampaignInfo& campaign) {
  std::string tier;
  const json spec = json::parse(store.spec_copies(campaign.id).resolved, nullptr, false);
  if (!spec.is_object() || !spec.contains("groups")) return "";
  for (const json& group : spec.at("groups")) {
    if (!group.contains("scene")) return "";
    const json& scene = group.at("scene");
    const std::string own = scene.value("tier", std::string());
    const bool has_sizes =
        (scene.contains("mesh") && !scene["mesh"].empty()) || varies_cells(group);
    if (own.empty() || has_sizes || (!tier.empty() && own != tier)) return "";
    tier = own;
  }
  return tier;
}

std::vector<ErrorBar> error_bars_of(const Store& store, const CampaignInfo& campaign) {
  std::vector<ErrorBar> bars = store.error_bars(campaign.name);
  if (bars.empty()) return bars;
  const std::string tier = common_tier(store, campaign);
  std::erase_if(bars, [&](const ErrorBar& bar) { return bar.tier != tier; });
  return bars;
}

StatedErrors stated_errors_of(const Store& store, const CampaignInfo& campaign) {
  StatedErrors errors = stated_errors(error_bars_of(store, campaign));
  const faultsim::Tier* tier = faultsim::find_tier(common_tier(store, campaign));
  if (tier != nullptr) errors.try_emplace("chi_bar", tier->chi_largest);
  return errors;
}

void SlidingCounts::add(bool slides, bool resolved) {
  ++n_cases;
  n_slide += slides ? 1 : 0;
  n_unresolved += slides && !resolved ? 1 : 0;
  n_perhaps += !slides && !resolved ? 1 : 0;
}

faultsim::StageMetrics metrics_of(const RankedCase& row) {
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

const faultsim::Measures& measures_of(const RankedCase& row) {
  return row.fault_metrics ? static_cast<const faultsim::Measures&>(*row.fault_metrics)
                           : row.metrics;
}

bool is_resolved(const RankedCase& row) {
  const faultsim::Measures& m = measures_of(row);
  return m.activation_resolved && row.weakening_resolved &&
         row.outcome != to_string(faultsim::Outcome::unresolved_event);
}

}  // namespace faultsweep
