#include "campaign/answers/limit_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "campaign/common/names.h"
#include "campaign/expansion/expansion.h"
#include "campaign/query/parameters.h"
#include "campaign/rounds/answers_of.h"
#include "campaign/spec/pointers.h"
#include "simulator/initial_state/initial_state.h"
#include "simulator/reading/read_scene.h"

namespace faultsweep {

namespace {

/// The last value that is safe: the end of the range where there is no limit in it, its beginning
/// where that is unsafe; none where that is not known.
std::optional<double> last_safe(const LimitCell& cell, const LimitSearch& limit) {
  if (const Crossing* crossing = cell.finding.limit()) return crossing->before.value;
  if (cell.finding.verdict == LimitVerdict::unknown) return std::nullopt;
  return cell.finding.verdict == LimitVerdict::safe_throughout ? limit.scan.back()
                                                               : limit.scan.front();
}

void find_width(LimitRow& row, const std::vector<LimitSearch>& limits) {
  std::optional<double> upper, lower, shortest;
  for (std::size_t l = 0; l < limits.size(); ++l) {
    if (!row.cells[l]) continue;
    const std::optional<double> safe = last_safe(*row.cells[l], limits[l]);
    if (!safe) return;
    row.is_open = row.is_open || row.cells[l]->finding.verdict == LimitVerdict::safe_throughout;
    const double from = limits[l].scan.front();
    if (limits[l].scan.back() > from) upper = std::min(upper.value_or(*safe), *safe);
    if (limits[l].scan.back() < from) lower = std::max(lower.value_or(*safe), *safe);
    shortest = std::min(shortest.value_or(INFINITY), std::abs(*safe - from));
  }
  const bool is_band = upper && lower && limits.front().unit == limits.back().unit;
  row.width = is_band ? *upper - *lower : shortest;
}

/// Of the last safe case: the first region whose pressure changes by the value in some load step.
std::optional<DatumPressure> datum_of(const Store& store, const CampaignInfo& campaign,
                                      const LimitCell& cell, const LimitSearch& limit) {
  const Crossing* crossing = cell.finding.limit();
  if (crossing == nullptr || limit.dimension != Dimension::pressure) return std::nullopt;
  const StoredCase one = store.stored_case(campaign.id, std::to_string(crossing->before.position));
  const BaseScene base = store.base_scene(one.scene);
  std::vector<Problem> problems;
  const faultsim::Scene scene = faultsim::read_scene(
      {base.source, scene_from_changes(base.document, one.changes), {}}, problems);
  if (!problems.empty()) return std::nullopt;
  const double change =
      faultsim::parse_quantity(concat(shortest_text(crossing->before.value), " ", limit.unit),
                               limit.dimension)
          .value;
  constexpr double kAlike = 1;  // Pa
  for (std::size_t r = 0; r < scene.pressure.size(); ++r) {
    const bool has_it =
        std::ranges::any_of(one.result.steps, [&](const faultsim::StepResult& step) {
          return r < step.pressure_change.size() &&
                 std::abs(step.pressure_change[r] - change) < kAlike;
        });
    if (!has_it) continue;
    const double depth = faultsim::region_top(scene, r);
    return DatumPressure{scene.pressure[r].region, depth,
                         faultsim::initial_region_pressure(scene, r, depth) + change};
  }
  return std::nullopt;
}

/// The places of the design's parameters among the campaign's: all but those that are searched.
std::vector<std::size_t> design_parameters(const std::vector<StoredParameter>& all,
                                           const std::vector<LimitSearch>& limits) {
  std::vector<std::size_t> places;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const bool is_searched = contains(limits, all[p].name, &LimitSearch::name);
    if (!is_searched) places.push_back(p);
  }
  return places;
}

/// A row per configuration and fault.
class LimitRows {
 public:
  LimitRows(const Store& store, const LimitTable& table) : store_(store), table_(table) {}
  void add(const LimitSearcher::Search& search, const std::vector<std::string>& settings) {
    const LimitSearch& limit = table_.limits[search.limit];
    LimitRow& row = rows_[{search.configuration, limit.faults[search.fault]}];
    row.configuration = search.configuration + 1;
    row.fault = limit.faults[search.fault];
    row.settings = settings;
    row.cells.resize(table_.limits.size());
    LimitCell& cell = row.cells[search.limit].emplace();
    cell.finding = search.finding;
    cell.datum = datum_of(store_, table_.campaign, cell, limit);
  }
  std::vector<LimitRow> ranked() {
    std::vector<LimitRow> all;
    for (auto& [key, row] : rows_) {
      find_width(row, table_.limits);
      all.push_back(std::move(row));
    }
    std::ranges::stable_sort(all, [](const LimitRow& a, const LimitRow& b) {
      return a.width.value_or(INFINITY) < b.width.value_or(INFINITY);
    });
    return all;
  }

 private:
  const Store& store_;
  const LimitTable& table_;
  std::map<std::pair<long, std::string>, LimitRow> rows_;
};

}  // namespace

LimitTable make_limit_table(const Store& store, const CampaignInfo& campaign) {
  const std::optional<StoredRounds> stored = stored_rounds(store, campaign);
  if (!stored || !stored->spec.contains("limits")) {
    throw InputError("limits", campaign.name + " does not search for limits",
                     "give its spec a section \"limits\"");
  }
  const LimitSearcher searcher = make_limit_searcher(parse_spec(*stored));
  const std::vector<RowAnswers> answers = answers_of(store, campaign, *stored, searcher, true);
  LimitTable table;
  table.campaign = campaign;
  table.limits = searcher.limits();
  const std::vector<StoredParameter>& parameters = campaign.parameters;
  const std::vector<std::size_t> places = design_parameters(parameters, table.limits);
  for (const std::size_t p : places) table.parameters.push_back(parameters[p].name);
  long n_values = 0;
  for (const LimitSearch& limit : table.limits) n_values += static_cast<long>(limit.scan.size());
  std::map<long, std::vector<std::string>> settings;  // by configuration
  for (const RowAnswers& one : answers) {
    if (one.round != 0 || settings.contains(one.row / n_values)) continue;
    const std::vector<std::string> labels = labels_of(one.parameters, parameters);
    for (const std::size_t p : places) settings[one.row / n_values].push_back(labels[p]);
  }
  LimitRows rows(store, table);
  table.is_finished = campaign.n_waiting == 0;
  for (const LimitSearcher::Search& one : searcher.search(answers, stored->designs)) {
    const LimitSearch& limit = table.limits[one.limit];
    if (!next_values(one.finding, limit.scan.front(), limit.tolerance).empty())
      table.is_finished = false;
    rows.add(one, settings[one.configuration]);
  }
  table.rows = rows.ranked();
  return table;
}

}  // namespace faultsweep
