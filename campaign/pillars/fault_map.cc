#include "campaign/pillars/fault_map.h"

#include <cmath>
#include <limits>

#include "campaign/common/names.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "campaign/render/answer.h"
#include "simulator/common/input_file.h"
#include "simulator/common/table_reader.h"
#include "simulator/common/units.h"

namespace faultsweep {

namespace {

constexpr std::size_t kMostPlacesBytes = 500'000'000;
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
    {"activation_depth", "first_sliding_depth", "m", 1},
    {"chi_bar", "chi_bar", "1", 1},
    {"max_slip", "max_slip", "mm", 1e-3},
    {"activated_area", "activated_area", "m2/m", 1},
    {"moment", "moment", "N m/m", 1},
    {"n_events", "slip_events", "1", 1},
    {"event_moment", "largest_event_moment", "N m/m", 1},
};

/// Fields of a line of CSV, RFC 4180.
std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

double number_in(const std::string& text) { return faultsim::parse_number(text).value_or(kNone); }

struct Places {
  std::vector<FaultMap::Place> all;
  std::string section_fault;
};

Places read_places(const std::filesystem::path& file) {
  const std::string text = faultsim::read_input_or_throw(file.string(), kMostPlacesBytes);
  Places places;
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::vector<std::string> fields = fields_of(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (fields.size() != 9 || (number == 1) != (fields[0] == "id"))
      throw InputError(file.string(), {{"", number, "is not a line of places.csv",
                                        "take the file that `faultsweep pillars` wrote"}});
    if (number == 1) continue;
    places.section_fault = fields[2];
    places.all.push_back({.id = fields[0],
                          .fault = fields[1],
                          .x = number_in(fields[3]),
                          .y = number_in(fields[4]),
                          .azimuth = number_in(fields[5]),
                          .dip = number_in(fields[6]),
                          .top_depth = number_in(fields[7]),
                          .base_depth = number_in(fields[8])});
  }
  return places;
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

}  // namespace

FaultMap make_fault_map(const Store& store, const CampaignInfo& campaign,
                        const std::filesystem::path& places_file) {
  const Places places = read_places(places_file);
  if (store.faults(campaign.id).empty())
    throw InputError(campaign.name, "no pillar has a result yet",
                     "run it first: faultsweep run " + campaign.name);
  const Selection selection = make_selection(store, campaign, "", places.section_fault);
  const std::map<std::string, ScopedMetric> known = known_metrics(selection);
  FaultMap map{campaign, places.all, {}, {}};
  Store::TableQuery query;
  query.by_design_row = true;
  query.fault = selection.fault->id;
  for (const Mapped& one : kMapped) {
    const ScopedMetric& metric = known.at(one.metric);
    map.properties.push_back({one.name, one.unit, metric.description, {}});
    query.columns.push_back({metric.sql, {}});
  }
  map.properties.push_back(
      {"first_sliding_time", "year", "end of the first load step in which it slides", {}});
  const std::map<long, double> times = first_times(store, campaign, selection.fault->id);
  store.for_each_case(campaign.id, query, [&](const CaseRow& row) {
    map.outcomes.push_back(row.outcome.empty() ? row.state : row.outcome);
    for (std::size_t k = 0; k < row.metrics.size(); ++k)
      map.properties[k].values.push_back(number_of(row.metrics[k]) / kMapped[k].per_unit);
    const auto time = times.find(row.position);
    map.properties.back().values.push_back(time == times.end() ? kNone : time->second);
  });
  if (map.outcomes.size() != map.places.size())
    throw InputError(places_file.string(),
                     concat(counted(map.places.size(), "place", "places"), ", but ", campaign.name,
                            " has ", counted(map.outcomes.size(), "pillar", "pillars")),
                     "take the places.csv that the campaign was made with");
  return map;
}

}  // namespace faultsweep
