#include "campaign/tradeoff/stored_ladder.h"

#include <algorithm>
#include <cmath>

#include "campaign/common/names.h"
#include "campaign/statistics/kendall.h"
#include "campaign/tradeoff/ladder.h"

namespace faultsweep {

namespace {

constexpr long kTop = 10;  // of a ranking, at most a third of it

/// Kendall's τ and how many of the first are the same.
void compare_places(const std::vector<std::pair<long, long>>& places, RankingTrade& trade) {
  std::vector<long> first, second;
  for (const auto& [a, b] : places) {
    first.push_back(a);
    second.push_back(b);
  }
  trade.tau = kendall_tau_b(first, second);
  trade.n_top = std::min(kTop, std::max(1L, trade.n_cases / 3));
  const auto is_top = [&](const std::vector<long>& all, std::size_t k) {
    return std::ranges::count_if(all, [&](long other) { return other < all[k]; }) < trade.n_top;
  };
  for (std::size_t k = 0; k < places.size(); ++k) {
    trade.n_top_common += is_top(first, k) && is_top(second, k);
  }
}

ErrorBar bar(const RankingTrade& trade, const std::string& metric,
             const std::map<std::string, double>& differences) {
  ErrorBar bar{"", trade.choice, metric, trade.reference, trade.n_cases, 0, 0};
  for (const auto& [name, difference] : differences) {
    bar.rms += difference * difference;
    bar.largest = std::max(bar.largest, std::abs(difference));
  }
  bar.rms = std::sqrt(bar.rms / static_cast<double>(differences.size()));
  return bar;
}

}  // namespace

StoredLadder::StoredLadder(const Store& store, const CampaignInfo& campaign,
                           const Expansion& expansion)
    : store_(store), campaign_(campaign), expansion_(expansion) {
  for (const Store::FamilyProgress& family : store.family_progress(campaign.id)) {
    families_.emplace(family.fingerprint, family);
  }
  for (const RankedCase& row : store.ranking(campaign.id, {})) {
    place_.emplace(row.position, static_cast<long>(place_.size()));
  }
}

std::map<std::string, long> StoredLadder::positions(const std::string& group) const {
  std::map<std::string, long> all;
  for (std::size_t g = 0; g < expansion_.spec.groups.size(); ++g) {
    if (expansion_.spec.groups[g].name != group) continue;
    const Parameter& choice = expansion_.spec.groups[g].parameters.at(0);
    for (std::size_t row = 0; row < choice.choices.size(); ++row) {
      const int index = expansion_.case_of_row[g].at(row);
      if (index >= 0) all.emplace(choice.choices[row].text, index + 1);
    }
  }
  return all;
}

TradeRun StoredLadder::run(long position) const {
  const StoredCase stored = store_.stored_case(campaign_.id, std::to_string(position));
  TradeRun run;
  const auto family = families_.find(stored.family);
  if (family != families_.end()) {
    run.operator_seconds = family->second.build_seconds.value_or(kUnknown);
    if (family->second.peak_bytes) run.peak_bytes = static_cast<double>(*family->second.peak_bytes);
  }
  if (stored.has_result && !faultsim::in_equilibrium(stored.result.outcome)) {
    // Its history ends early: the axis would be compared up to there only.
    run.trouble = concat(to_string(stored.result.outcome), ": ", stored.result.reason);
  } else if (stored.has_result) {
    run.result = stored.result;
    run.case_seconds = stored.result.seconds;
  } else if (!stored.runs.empty()) {
    run.trouble = concat(stored.runs.back().status, ": ", stored.runs.back().reason);
  } else {
    run.trouble = "not run";
  }
  return run;
}

std::vector<TradeRun> StoredLadder::runs(const TradeAxis& axis) const {
  const auto where = positions(axis.name);
  std::vector<TradeRun> all;
  for (const TradeChoice& choice : axis.choices) {
    const auto position = where.find(choice.name);
    all.push_back(position == where.end() ? TradeRun() : run(position->second));
  }
  return all;
}

void StoredLadder::add_cost(long position, const TradeRun& run, SecondsByFamily& operators,
                            double& seconds) const {
  if (!std::isnan(run.case_seconds)) seconds += run.case_seconds;
  const std::size_t index = static_cast<std::size_t>(position - 1);
  const Family& family = expansion_.families[expansion_.cases[index].family];
  if (!std::isnan(run.operator_seconds)) operators[family.fingerprint] = run.operator_seconds;
}

RankingTrade StoredLadder::rank(const std::string& tier, const std::string& reference,
                                std::vector<ErrorBar>& bars) const {
  const auto a = positions(sample_group(tier)), b = positions(sample_group(reference));
  RankingTrade trade;
  trade.choice = tier;
  trade.reference = reference;
  std::map<std::string, double> chi, slip;  // differences
  std::vector<std::pair<long, long>> places;
  SecondsByFamily operators_a, operators_b;
  for (const auto& [name, position] : a) {
    const TradeRun one = run(position), other = run(b.at(name));
    add_cost(position, one, operators_a, trade.seconds);
    add_cost(b.at(name), other, operators_b, trade.reference_seconds);
    if (!one.result || !other.result) continue;
    places.emplace_back(place_.at(position), place_.at(b.at(name)));
    chi[name] = one.result->whole.chi_bar - other.result->whole.chi_bar;
    slip[name] = one.result->whole.max_slip - other.result->whole.max_slip;
    trade.n_flips += one.result->whole.activated != other.result->whole.activated;
  }
  trade.n_cases = static_cast<long>(places.size());
  for (const auto& [fingerprint, seconds] : operators_a) trade.seconds += seconds;
  for (const auto& [fingerprint, seconds] : operators_b) trade.reference_seconds += seconds;
  if (places.empty()) return trade;
  compare_places(places, trade);
  bars.push_back(bar(trade, "chi_bar", chi));
  bars.push_back(bar(trade, "max_slip", slip));
  trade.chi_rms = bars[bars.size() - 2].rms;
  trade.chi_max = bars[bars.size() - 2].largest;
  return trade;
}

}  // namespace faultsweep
