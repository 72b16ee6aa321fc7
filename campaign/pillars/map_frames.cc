#include "campaign/pillars/map_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "campaign/common/names.h"
#include "campaign/query/selection.h"
#include "campaign/query/table_output.h"
#include "simulator/common/dates.h"
#include "simulator/common/units.h"

namespace faultsweep {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kSecond = 1;  // of rounding: load steps end at frames
constexpr double kBar = 1e5;   // Pa

struct FrameProperty {
  const char *name, *unit, *meaning;
};
constexpr FrameProperty kFrameProperties[] = {
    {"slides", "1", "has begun to slide"},
    {"chi_bar", "1", "critical index"},
    {"max_slip", "mm", "largest slip since the start"},
    {"pressure_change_footwall", "bar", "in the western block; with a flow field, its mean"},
    {"pressure_change_hanging_wall", "bar", "in the eastern block"},
};
constexpr std::size_t kProperties = std::size(kFrameProperties);

/// The end of a load step of a case.
struct HistoryPoint {
  double time = 0;  ///< s.
  std::array<double, kProperties> values{};
};
using CaseHistories = std::map<long, std::vector<HistoryPoint>>;  ///< by position.

std::size_t column_index(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  FAULTSIM_DEMAND(found != names.end(), name);
  return static_cast<std::size_t>(found - names.begin());
}

CaseHistories read_case_histories(const Store& store, const FaultMap& map) {
  const Store::Kinds kinds = store.kinds(map.campaign.id, {});
  const std::vector<std::string> names = Store::history_columns(kinds);
  const std::size_t position = column_index(names, "case"), time = column_index(names, "time_s"),
                    change = column_index(names, "pressure_change_pa"),
                    chi = column_index(names, "chi_bar"), slip = column_index(names, "max_slip_m");
  CaseHistories all;
  Store::TableQuery query;
  query.fault = map.fault;
  store.for_each_history_row(map.campaign.id, query, kinds, [&](const std::vector<Cell>& row) {
    HistoryPoint point{number_of(row[time]), {0, number_of(row[chi]), 1e3 * number_of(row[slip])}};
    const auto* changes = std::get_if<std::string>(&row[change]);
    const auto regions = nlohmann::json::parse(changes != nullptr ? *changes : "[]");
    for (std::size_t side = 0; side < 2; ++side)
      point.values[3 + side] =
          side < regions.size() ? regions[side].get<double>() / kBar : kUnknown;
    all[static_cast<long>(number_of(row[position]))].push_back(point);
  });
  return all;
}

/// Marks the points from which on a case slides.
void mark_sliding(const Store& store, const FaultMap& map, CaseHistories& histories) {
  store.for_each_onset(map.campaign.id, {}, [&](const CaseOnsets& one) {
    const auto history = histories.find(one.position);
    if (history == histories.end()) return;
    for (const CaseOnsets::Onset& onset : one.onsets) {
      if (onset.fault != map.fault) continue;
      for (HistoryPoint& point : history->second)
        point.values[0] = point.time >= onset.time - kSecond ? 1 : 0;
    }
  });
}

/// The times of frames, as s since 1970 or since time 0, and what years they are called.
struct FrameTimes {
  bool are_dates = false;
  std::vector<double> at, year;
};

double new_year(int year) { return *faultsim::parse_date(concat(year, "-01-01")); }

/// Years to a time, s: of the calendar, or from 0 on.
double year_of(double time, bool is_date) {
  if (!is_date) return time / kYear;
  const int year = std::stoi(faultsim::date_text(time));
  return year + (time - new_year(year)) / (new_year(year + 1) - new_year(year));
}

/// The first and the last time that a history of the map has; none of no history.
std::optional<std::pair<double, double>> time_range(const FaultMap& map,
                                                    const CaseHistories& histories,
                                                    bool are_dates) {
  std::optional<std::pair<double, double>> range;
  for (const FaultMap::Place& place : map.places) {
    const auto history = histories.find(place.position);
    if (history == histories.end()) continue;
    const double zero = are_dates ? *faultsim::parse_date(place.start_date) : 0;
    const double from = zero + history->second.front().time,
                 to = zero + history->second.back().time;
    range = range ? std::pair(std::min(range->first, from), std::max(range->second, to))
                  : std::pair(from, to);
  }
  return range;
}

/// The beginning of the first history, each year that begins behind it, the end of the last one.
FrameTimes frame_times(const FaultMap& map, const CaseHistories& histories) {
  FrameTimes times;
  times.are_dates = std::ranges::all_of(map.places, [](const FaultMap::Place& one) {
    return one.position == 0 || faultsim::parse_date(one.start_date);
  });
  const auto range = time_range(map, histories, times.are_dates);
  if (!range) return times;
  const auto [first, last] = *range;
  times.at.push_back(first);
  const int from = static_cast<int>(std::floor(year_of(first, times.are_dates)));
  for (int year = from + 1;; ++year) {
    const double at = times.are_dates ? new_year(year) : year * kYear;
    if (at >= last - kSecond) break;
    if (at > first + kSecond) times.at.push_back(at);
  }
  if (last > first) times.at.push_back(last);
  for (const double at : times.at) times.year.push_back(year_of(at, times.are_dates));
  return times;
}

/// The last point by a time; none before the first one and after the last.
const HistoryPoint* point_at(const std::vector<HistoryPoint>& history, double time) {
  const auto behind = std::ranges::upper_bound(history, time + kSecond, {}, &HistoryPoint::time);
  if (behind == history.begin()) return nullptr;
  if (behind == history.end() && history.back().time < time - kSecond) return nullptr;
  return &*(behind - 1);
}

}  // namespace

std::vector<MapFrame> make_map_frames(const Store& store, const FaultMap& map) {
  CaseHistories histories = read_case_histories(store, map);
  mark_sliding(store, map, histories);
  const FrameTimes times = frame_times(map, histories);
  std::vector<MapFrame> frames;
  for (std::size_t k = 0; k < times.at.size(); ++k) {
    MapFrame frame{times.year[k], {}};
    for (const FrameProperty& one : kFrameProperties)
      frame.properties.push_back({one.name, one.unit, one.meaning, {}});
    for (const FaultMap::Place& place : map.places) {
      const auto history = histories.find(place.position);
      const double zero =
          times.are_dates && place.position > 0 ? *faultsim::parse_date(place.start_date) : 0;
      const HistoryPoint* point =
          history == histories.end() ? nullptr : point_at(history->second, times.at[k] - zero);
      for (std::size_t p = 0; p < kProperties; ++p)
        frame.properties[p].values.push_back(point != nullptr ? point->values[p] : kUnknown);
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::string frames_to_pvd(const std::vector<FrameFile>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const FrameFile& one : files)
    text += concat("<DataSet timestep=\"", rounded_number(one.year), "\" part=\"0\" file=\"",
                   one.name, "\"/>\n");
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace faultsweep
