#include "campaign/reports/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <tuple>
#include <unordered_map>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "campaign/statistics/kendall.h"

namespace faultsweep {

double relative_difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

long Comparison::count(bool ComparedPair::*flag) const {
  return std::ranges::count_if(pairs, [&](const ComparedPair& p) { return p.*flag; });
}

long Comparison::n_beyond() const {
  return std::ranges::count_if(pairs, [&](const ComparedPair& p) {
    return p.outcome_differs || p.flipped || p.worst > request.tolerance;
  });
}

namespace {

/// A case as it is compared.
struct Side : CaseRow {
  std::string key;         ///< values of the shared parameters; "" = none are shared.
  std::string ended = {};  ///< its outcome, or the status of the failed run; "" = not run.
  bool activated = false, plane_strain = false;
  std::vector<double> numbers = {};  ///< its metrics; NaN = missing.
  bool has_result() const { return rank_class.has_value(); }
};

/// Where the shared parameters stand in a campaign's parameter vectors.
std::vector<std::size_t> places_of(const std::vector<std::string>& names,
                                   const CampaignInfo& campaign) {
  std::vector<std::size_t> places;
  const auto& parameters = campaign.parameters;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(parameters, name, &StoredParameter::name);
    places.push_back(static_cast<std::size_t>(found - parameters.begin()));
  }
  return places;
}

std::string key_of(const CaseParameters& values, const std::vector<std::size_t>& places) {
  std::string key;
  for (const std::size_t place : places) {
    for (const CaseParameter& one : values) {
      if (static_cast<std::size_t>(one.index) != place) continue;
      key += one.si ? exact_number(*one.si) : '"' + one.text;
    }
    key += '\n';
  }
  return key;
}

/// @param metrics  of that campaign, in the order of comparison.metrics.
std::vector<Side> read_side(const Store& store, const CampaignInfo& campaign,
                            const std::vector<ScopedMetric>& metrics,
                            const Comparison& comparison) {
  Store::TableQuery query;
  query.stage = comparison.request.stage;
  query.columns = {{metric_sql("slides"), {}}, {metric_sql("plane_strain"), {}}};
  for (const ScopedMetric& metric : metrics) query.columns.push_back({metric.sql, {}});
  const std::vector<std::size_t> places = places_of(comparison.shared_parameters, campaign);
  std::vector<Side> cases;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    Side side{row, key_of(row.parameters, places)};
    side.ended = side.has_result() ? row.outcome : row.state == "failed" ? row.status : "";
    for (const Cell& cell : side.metrics) side.numbers.push_back(number_of(cell));
    side.activated = side.numbers[0] > 0;
    side.plane_strain = side.numbers[1] > 0;
    side.numbers.erase(side.numbers.begin(), side.numbers.begin() + 2);
    side.metrics.clear(), side.metrics.shrink_to_fit();  // many cases
    cases.push_back(std::move(side));
  });
  return cases;
}

std::vector<std::string> shared_parameters(const CampaignInfo& a, const CampaignInfo& b) {
  std::vector<std::string> names;
  const auto& others = b.parameters;
  for (const StoredParameter& one : a.parameters) {
    const bool shared = std::ranges::any_of(others, [&](const StoredParameter& p) {
      return p.name == one.name && p.is_text == one.is_text && p.dimension == one.dimension;
    });
    if (shared) names.push_back(one.name);
  }
  return names;
}

using Matches = std::vector<std::pair<const Side*, const Side*>>;

/// The cases that `field` names uniquely among those not matched yet.
std::unordered_map<std::string, const Side*> index_by(const std::vector<Side>& cases,
                                                      const std::set<const Side*>& matched,
                                                      std::string Side::*field, long& n_ambiguous) {
  std::unordered_map<std::string, const Side*> found;
  for (const Side& one : cases) {
    if (matched.contains(&one)) continue;
    const auto [place, is_new] = found.try_emplace(one.*field, &one);
    if (is_new) continue;
    n_ambiguous += place->second == nullptr ? 1 : 2;
    place->second = nullptr;
  }
  return found;
}

/// Matches what `field` names uniquely on both sides; returns how many are new.
long match_by(const std::vector<Side>& a, const std::vector<Side>& b, std::string Side::*field,
              std::set<const Side*>& matched, Matches& matches, long& n_ambiguous) {
  const auto in_a = index_by(a, matched, field, n_ambiguous);
  const auto in_b = index_by(b, matched, field, n_ambiguous);
  long n_new = 0;
  for (const Side& one : a) {
    const auto self = in_a.find(one.*field);
    if (self == in_a.end() || self->second != &one) continue;
    const auto other = in_b.find(one.*field);
    if (other == in_b.end() || other->second == nullptr) continue;
    matches.emplace_back(&one, other->second);
    matched.insert({&one, other->second});
    ++n_new;
  }
  return n_new;
}

Matches match(const std::vector<Side>& a, const std::vector<Side>& b, Comparison& comparison) {
  Matches matches;
  std::set<const Side*> matched;
  long unused = 0;  // identities are unique in a campaign
  comparison.n_by_identity = match_by(a, b, &Side::identity, matched, matches, unused);
  if (!comparison.shared_parameters.empty()) {
    comparison.n_by_parameters =
        match_by(a, b, &Side::key, matched, matches, comparison.n_ambiguous);
  }
  comparison.n_only_a = static_cast<long>(a.size() - matches.size());
  comparison.n_only_b = static_cast<long>(b.size() - matches.size());
  return matches;
}

void compare_metric(MetricDifference& difference, const Side& a, const Side& b, double x, double y,
                    double tolerance) {
  const double relative = relative_difference(x, y);
  difference.n_beyond += relative > tolerance ? 1 : 0;
  if (std::isnan(x) || std::isnan(y)) {
    difference.n_one_missing += std::isnan(x) == std::isnan(y) ? 0 : 1;
    return;
  }
  ++difference.n_compared;
  difference.max_absolute = std::max(difference.max_absolute, std::abs(x - y));
  if (relative > difference.max_relative) {
    difference.max_relative = relative;
    difference.worst_a = a.position;
    difference.worst_b = b.position;
  }
}

bool same_bits(double x, double y) {
  return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) ||
         (std::isnan(x) && std::isnan(y));
}

ComparedPair compare_pair(const Side& a, const Side& b, Comparison& comparison) {
  ComparedPair pair;
  pair.a = a.position;
  pair.b = b.position;
  pair.parameters = a.parameters;
  pair.outcome_a = a.ended;
  pair.outcome_b = b.ended;
  pair.outcome_differs = a.ended != b.ended;
  pair.identical = !pair.outcome_differs;
  if (!a.has_result() || !b.has_result()) return pair;
  pair.flipped = a.activated != b.activated;
  for (std::size_t k = 0; k < a.numbers.size(); ++k) {
    const double x = a.numbers[k], y = b.numbers[k];
    compare_metric(comparison.metrics[k], a, b, x, y, comparison.request.tolerance);
    pair.identical = pair.identical && same_bits(x, y);
    const double relative = relative_difference(x, y);
    if (relative <= pair.worst) continue;
    pair.worst = relative;
    pair.worst_metric = k;
    pair.worst_a = x;
    pair.worst_b = y;
  }
  return pair;
}

/// A plane-strain result beside one in 3D: areas, potency and moments would compare a number per
/// metre of strike with a total.
void refuse_other_kind(const Side& a, const Side& b, const Comparison& comparison) {
  if (!a.has_result() || !b.has_result() || a.plane_strain == b.plane_strain) return;
  const auto dimension = [](const Side& side) {
    return side.plane_strain ? "plane strain, per metre of strike" : "3D, a total";
  };
  for (const MetricDifference& one : comparison.metrics) {
    if (!one.metric.is_extensive()) continue;
    throw InputError(
        "--metrics",
        concat(one.metric.name, " cannot be compared: case ", a.position, " of A is ", dimension(a),
               "; case ", b.position, " of B is ", dimension(b)),
        "name metrics other than areas, potencies and moments: --metrics chi_bar,max_slip");
  }
}

/// Places in the default order by case number, from 0; equal ones share theirs.
std::unordered_map<long, long> places(const Store& store, const CampaignInfo& campaign,
                                      const std::string& stage) {
  Store::RankingQuery query;
  query.stage = stage;
  std::unordered_map<long, long> places;
  long place = -1;
  const auto order_of = [](const RankedCase& row) {
    const double margin = row.pressure_margin.value_or(std::numeric_limits<double>::infinity());
    return std::tuple(row.rank_class, row.metrics.activated_area, row.metrics.open_area,
                      row.metrics.moment, margin, row.metrics.chi_bar);
  };
  const std::vector<RankedCase> rows = store.ranking(campaign.id, query);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k == 0 || order_of(rows[k]) != order_of(rows[k - 1])) ++place;
    places[rows[k].position] = place;
  }
  return places;
}

/// The indices of the k smallest places.
std::set<std::size_t> highest(const std::vector<long>& places, std::size_t k) {
  std::vector<std::size_t> order(places.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order,
                           [&](std::size_t i, std::size_t j) { return places[i] < places[j]; });
  return {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(k)};
}

/// @param ranked  pairs with two full histories.
void compare_rankings(const Store& store_a, const Store& store_b, const Matches& ranked,
                      Comparison& comparison) {
  constexpr std::size_t kTop = 10;
  const auto all_a = places(store_a, comparison.a, comparison.request.stage);
  const auto all_b = places(store_b, comparison.b, comparison.request.stage);
  std::vector<long> in_a, in_b;
  for (const auto& [a, b] : ranked) {
    in_a.push_back(all_a.at(a->position));
    in_b.push_back(all_b.at(b->position));
  }
  comparison.n_ranked = static_cast<long>(ranked.size());
  comparison.tau_b = kendall_tau_b(in_a, in_b);
  const std::size_t n_top = std::min(kTop, ranked.size());
  comparison.n_top = static_cast<long>(n_top);
  const std::set<std::size_t> top_b = highest(in_b, n_top);
  for (const std::size_t k : highest(in_a, n_top)) comparison.n_top_shared += top_b.contains(k);
}

bool is_same_store(const Store& a, const Store& b) {
  std::error_code error;
  return std::filesystem::equivalent(a.folder(), b.folder(), error);
}

}  // namespace

Comparison compare_campaigns(const Store& store_a, const CampaignInfo& a, const Store& store_b,
                             const CampaignInfo& b, const CompareRequest& request) {
  const Selection selection_a = make_selection(store_a, a, request.stage, "");
  const Selection selection_b = make_selection(store_b, b, request.stage, "");
  Comparison comparison;
  comparison.a = a;
  comparison.b = b;
  comparison.request = request;
  comparison.shared_parameters = shared_parameters(a, b);
  const bool creep = creeps(store_a, a) || creeps(store_b, b);
  const auto metrics_a = choose_metrics(selection_a, request.metrics, true, creep);
  const auto metrics_b = choose_metrics(selection_b, request.metrics, true, creep);
  for (const ScopedMetric& metric : metrics_a) {
    comparison.metrics.emplace_back();
    comparison.metrics.back().metric = metric;
  }
  const std::vector<Side> cases_a = read_side(store_a, a, metrics_a, comparison);
  const std::vector<Side> cases_b = read_side(store_b, b, metrics_b, comparison);
  const bool same_store = is_same_store(store_a, store_b);
  Matches ranked;
  for (const auto& [one, other] : match(cases_a, cases_b, comparison)) {
    const bool neither = !one->has_result() && !other->has_result();
    if (neither || one->ended.empty() || other->ended.empty()) {
      ++comparison.n_without;
    } else if (same_store && one->id == other->id) {
      ++comparison.n_same_result;
    } else {
      refuse_other_kind(*one, *other, comparison);
      comparison.pairs.push_back(compare_pair(*one, *other, comparison));
      (one->plane_strain ? comparison.kinds.plane_strain : comparison.kinds.total) = true;
      if (one->complete() && other->complete()) ranked.emplace_back(one, other);
    }
  }
  compare_rankings(store_a, store_b, ranked, comparison);
  const auto badness = [](const ComparedPair& p) {
    return std::tuple(!p.flipped, !p.outcome_differs, -p.worst, p.a);
  };
  std::ranges::sort(comparison.pairs, [&](const ComparedPair& p, const ComparedPair& q) {
    return badness(p) < badness(q);
  });
  return comparison;
}

}  // namespace faultsweep
