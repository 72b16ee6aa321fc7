#include "campaign/pillars/fault_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaign/common/names.h"
#include "campaign/pillars/place_line.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "campaign/render/answer.h"
#include "simulator/common/dates.h"
#include "simulator/common/units.h"

namespace faultsweep {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A metric of the pillar's fault, in the unit of maps.
struct Mapped {
  const char *metric, *name, *unit;
  double per_unit;  ///< SI of it.
};
constexpr Mapped kMapped[] = {
    {"slides", "slides", "1", 1},
    {"activation_resolved", "resolved", "1", 1},
    {"activation_pressure_absolute", "first_sliding_pressure", "bar", 1e5},
    {"activation_pressure_change", "first_sliding_pressure_change", "bar", 1e5},
    {"activation_change_before", "not_yet_at_pressure_change", "bar", 1e5},
    {"activation_depth", "first_sliding_depth", "m", 1},
    {"chi_bar", "chi_bar", "1", 1},
    {"max_slip", "max_slip", "mm", 1e-3},
    {"activated_area", "activated_area", "m2/m", 1},
    {"moment", "moment", "N m/m", 1},
    {"n_events", "slip_events", "1", 1},
    {"event_moment", "largest_event_moment", "N m/m", 1},
};

FaultMap::Place map_place(const PlaceLine& line) {
  return {.id = line.id,
          .fault = line.fault,
          .x = line.x.value_or(kNone),
          .y = line.y.value_or(kNone),
          .azimuth = line.azimuth.value_or(kNone),
          .dip = line.dip.value_or(kNone),
          .top_depth = line.top_depth.value_or(kNone),
          .base_depth = line.base_depth.value_or(kNone),
          .start_date = line.start_date};
}

/// When the pillar's fault began to slide, by position of the case, years.
std::map<long, double> first_times(const Store& store, const CampaignInfo& campaign,
                                   std::int64_t fault) {
  std::map<long, double> times;
  store.for_each_onset(campaign.id, {}, [&](const CaseOnsets& one) {
    for (const CaseOnsets::Onset& onset : one.onsets) {
      if (onset.fault == fault) times[one.position] = onset.time / kYear;
    }
  });
  return times;
}

/// A date as many years later; "" where it is not known.
std::string date_after(const std::string& start, double years) {
  const auto zero = faultsim::parse_date(start);
  return zero && std::isfinite(years) ? faultsim::date_text(*zero + years * kYear) : "";
}

/// What became of the case of a place, which slides first at a time, years.
void fill(const CaseRow& row, double time, FaultMap::Place& place, FaultMap& map) {
  const auto i = static_cast<std::size_t>(&place - map.places.data());
  place.position = row.position;
  map.outcomes[i] = row.outcome.empty() ? row.state : row.outcome;
  for (std::size_t k = 0; k < row.metrics.size(); ++k)
    map.properties[k].values[i] = number_of(row.metrics[k]) / kMapped[k].per_unit;
  map.properties[row.metrics.size()].values[i] = time;
  map.first_dates[i] = date_after(place.start_date, time);
  map.properties.back().values[i] = 0;
}

/// The places of a file that are cases of the campaign, in their order.
std::vector<FaultMap::Place*> cases_of(FaultMap& map, const std::vector<PlaceLine>& lines) {
  std::vector<FaultMap::Place*> cases;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].refused.empty()) cases.push_back(&map.places[i]);
  return cases;
}

/// Of refused pillars there are no values.
void fill_refused(FaultMap& map) {
  map.outcomes.resize(map.places.size(), "refused");
  map.first_dates.resize(map.places.size());
  for (FaultMap::Property& one : map.properties) one.values.resize(map.places.size(), kNone);
  std::vector<double> refused;
  for (const FaultMap::Place& place : map.places) refused.push_back(place.position == 0 ? 1 : 0);
  map.properties.push_back({"refused", "1", "is not among the cases: see refused.csv", refused});
}

}  // namespace

bool FaultMap::Place::has_panel() const {
  const double all = x + y + azimuth + dip + top_depth + base_depth;
  return std::isfinite(all);
}

FaultMap make_fault_map(const Store& store, const CampaignInfo& campaign,
                        const std::filesystem::path& places_file) {
  const std::vector<PlaceLine> lines = read_places(places_file);
  if (store.faults(campaign.id).empty())
    throw InputError(campaign.name, "no pillar has a result yet",
                     "run it first: faultsweep run " + campaign.name);
  const auto any = std::ranges::find(lines, "", &PlaceLine::refused);
  if (any == lines.end())
    throw InputError(places_file.string(), "none of its places is a case",
                     "use the places.csv that was written with the campaign");
  const Selection selection = make_selection(store, campaign, "", any->section_fault);
  const std::map<std::string, ScopedMetric> known = known_metrics(selection);
  FaultMap map;
  map.campaign = campaign;
  map.fault = selection.fault->id;
  map.places = mapped(lines, map_place);
  Store::TableQuery query;
  query.by_design_row = true;
  query.fault = map.fault;
  for (const Mapped& one : kMapped) {
    const ScopedMetric& metric = known.at(one.metric);
    map.properties.push_back({one.name, one.unit, metric.description, {}});
    query.columns.push_back({metric.sql, {}});
  }
  map.properties.push_back({"first_sliding_time", "year", "when it was first found to slide", {}});
  fill_refused(map);
  const std::vector<FaultMap::Place*> cases = cases_of(map, lines);
  const std::map<long, double> times = first_times(store, campaign, map.fault);
  std::size_t n_rows = 0;
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    if (n_rows++ >= cases.size()) return;
    FaultMap::Place& place = *cases[n_rows - 1];
    const auto time = times.find(row.position);
    fill(row, time == times.end() ? kNone : time->second, place, map);
  });
  if (n_rows != cases.size())
    throw InputError(places_file.string(),
                     concat(counted(cases.size(), "place", "places"), ", but ", campaign.name,
                            " has ", counted(n_rows, "pillar", "pillars")),
                     "use the places.csv that was written with the campaign");
  return map;
}

}  // namespace faultsweep
