#include "campaign/answers/why.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "campaign/answers/sample.h"
#include "campaign/common/names.h"
#include "campaign/query/parameters.h"
#include "campaign/query/selection.h"
#include "simulator/scene/tiers.h"

namespace faultsweep {

namespace {

const RankedCase& row_of(const Ranking& ranking, const StoredCase& stored) {
  for (const RankedCase& row : ranking.rows)
    if (row.position == stored.position) return row;
  const std::string what = concat("case ", stored.position, " of ", ranking.campaign.name);
  if (!stored.has_result) refuse_unrun("--why", what + " has no result yet", ranking.campaign);
  throw InputError("--why", what + " is not among the cases that are ranked",
                   "leave out --where, or choose a --stage that its history reaches");
}

/// Of the stage that the ranking is of.
faultsim::StageMetrics stage_of(const faultsim::CaseResult& result, const std::string& stage) {
  for (const faultsim::StageMetrics& one : result.stages)
    if (one.stage == stage) return one;
  return result.whole;
}

/// What the rows are compared by: the score, or the columns of the default order.
double compared_value(const Why& why, const RankedCase& row) {
  if (!why.ranking.by_default) return row.score.value_or(std::numeric_limits<double>::quiet_NaN());
  const faultsim::Measures& m = measures_of(row);
  return why.compared == "chi_bar" ? m.chi_bar : m.activated_area;
}

/// The only parameter but `names` in which two cases differ; none where they differ in more, in
/// none, or do not have the same parameters (of another group of designs).
std::optional<std::size_t> only_difference(const CaseParameters& a, const CaseParameters& b,
                                           int names) {
  if (a.size() != b.size()) return std::nullopt;
  std::optional<std::size_t> found;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].index != b[k].index) return std::nullopt;
    const bool same = a[k].si && b[k].si ? *a[k].si == *b[k].si : a[k].text == b[k].text;
    if (same || a[k].index == names) continue;
    if (found) return std::nullopt;
    found = k;
  }
  return found;
}

/// Of a parameter with numbers only the next value on either side is a neighbour's.
struct NextValues {
  double below = -std::numeric_limits<double>::infinity();
  double above = std::numeric_limits<double>::infinity();
};

std::vector<Neighbour> neighbours_of(const Why& why) {
  const auto& parameters = why.ranking.campaign.parameters;
  const CaseParameters& own = why.row.parameters;
  std::vector<std::pair<std::size_t, const RankedCase*>> near;
  std::map<std::size_t, NextValues> next;
  for (const RankedCase& row : why.ranking.rows) {
    const auto k = only_difference(own, row.parameters, why.names);
    if (!k || row.rank_class > 1) continue;
    // Another group may have other fixed settings, which are not a parameter's doing.
    if (parameters[static_cast<std::size_t>(own[*k].index)].name == "group") continue;
    near.emplace_back(*k, &row);
    const auto &from = own[*k].si, &to = row.parameters[*k].si;
    if (!from || !to) continue;
    NextValues& values = next[*k];
    if (*to < *from) values.below = std::max(values.below, *to);
    if (*to > *from) values.above = std::min(values.above, *to);
  }
  std::vector<Neighbour> neighbours;
  for (const auto& [k, row] : near) {
    const CaseParameter &from = own[k], &to = row->parameters[k];
    const bool numbers = from.si && to.si;
    if (numbers && *to.si != next[k].below && *to.si != next[k].above) continue;
    const double value = compared_value(why, *row);
    neighbours.push_back({parameters[static_cast<std::size_t>(from.index)].name, from.text, to.text,
                          *row, value, value - why.value});
  }
  // What has no value to compare comes last.
  const auto size = [](const Neighbour& one) {
    return std::isfinite(one.change) ? std::abs(one.change) : -1;
  };
  std::ranges::stable_sort(
      neighbours, [&](const Neighbour& a, const Neighbour& b) { return size(a) > size(b); });
  return neighbours;
}

/// The cases of the ranking as points; those of other rank classes have no value to compare.
ParameterSpace space_of(const Why& why) {
  ParameterSpace space;
  const std::size_t n = why.ranking.rows.size();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const StoredParameter& one : why.ranking.campaign.parameters)
    space.columns.push_back({one.name, std::vector<double>(n, none), one.is_text});
  std::vector<std::map<std::string, double>> words(space.columns.size());
  for (std::size_t r = 0; r < n; ++r) {
    for (const CaseParameter& one : why.ranking.rows[r].parameters) {
      const auto k = static_cast<std::size_t>(one.index);
      ParameterSpace::Column& column = space.columns[k];
      column.is_words = column.is_words || !one.si;
      const double number = static_cast<double>(words[k].size());
      if (one.index == why.names) {
        column.values[r] = 0;  // alike, as far as names go
        continue;
      }
      column.values[r] = one.si ? *one.si : words[k].try_emplace(one.text, number).first->second;
    }
  }
  return space;
}

/// What is around a case of which no other differs in one parameter alone.
void add_neighbourhood(Why& why) {
  constexpr std::size_t kNearest = 8;
  const std::vector<RankedCase>& rows = why.ranking.rows;
  const ParameterSpace space = space_of(why);
  std::vector<double> values;
  std::size_t here = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].position == why.row.position) here = r;
    values.push_back(rows[r].rank_class > 1 ? std::numeric_limits<double>::quiet_NaN()
                                            : compared_value(why, rows[r]));
  }
  const std::vector<double> distances = distances_from(space, here);
  for (const std::size_t r : nearest(distances, here, kNearest))
    why.nearest.push_back({rows[r], distances[r], values[r], values[r] - why.value});
  why.plane = local_plane(space, values, here);
}

/// Measured for the campaign, else of χ̄ what its tier names.
std::optional<ErrorBar> error_of(const Store& store, const Why& why) {
  for (const ErrorBar& bar : why.ranking.error_bars)
    if (bar.metric == why.compared) return bar;
  const faultsim::Tier* tier = faultsim::find_tier(common_tier(store, why.ranking.campaign));
  if (why.compared != "chi_bar" || tier == nullptr) return std::nullopt;
  ErrorBar named;
  named.tier = tier->name;
  named.metric = why.compared;
  named.reference = "the limit of small cells in plane strain";
  named.rms = tier->chi_rms;
  return named;
}

Place place_of(const Store& store, const Why& why) {
  Place place;
  place.error = error_of(store, why);
  const double margin = place.error ? std::sqrt(2.0) * place.error->rms : 0;
  for (const RankedCase& row : why.ranking.rows) {
    if (row.rank_class != why.row.rank_class) continue;
    ++place.n_ranked;
    if (row.position == why.row.position) {
      place.place = place.n_ranked;
    } else if (std::abs(compared_value(why, row) - why.value) <= margin) {
      place.ties.push_back(row.position);
    }
  }
  return place;
}

}  // namespace

Why explain_rank(const Store& store, const CampaignInfo& campaign, const StoredCase& stored,
                 RankRequest request) {
  request.top = 0;
  request.skip.reset();
  Why why;
  why.ranking = make_ranking(store, campaign, request);
  why.stored = stored;
  why.row = row_of(why.ranking, stored);
  const std::string names = names_parameter(store, campaign);
  for (std::size_t k = 0; k < campaign.parameters.size(); ++k)
    if (campaign.parameters[k].name == names) why.names = static_cast<int>(k);
  why.metrics = stage_of(stored.result, request.stage);
  why.compared = !why.ranking.by_default          ? why.ranking.request.by
                 : measures_of(why.row).activated ? "activated_area"
                                                  : "chi_bar";
  why.value = compared_value(why, why.row);
  why.place = place_of(store, why);
  why.neighbours = neighbours_of(why);
  if (why.neighbours.empty()) add_neighbourhood(why);
  try {
    why.global = analyse_sensitivity(
        store, campaign,
        {.cases = {.where = request.where, .stage = request.stage, .fault = request.fault},
         .metrics = why.compared});
  } catch (const InputError& error) {
    // Not every campaign is a sample, and not every expression a metric: the rest stands without.
    why.no_global = error.what();
  }
  return why;
}

}  // namespace faultsweep
