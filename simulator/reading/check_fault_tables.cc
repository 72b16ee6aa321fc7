#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "simulator/common/dates.h"
#include "simulator/initial_state/fault_pressure.h"
#include "simulator/initial_state/load_times.h"
#include "simulator/reading/scene_reader.h"

/// Tables of fault pressure against their fault and the history: constant beyond their places and
/// their last time, they must at least meet the fault, and what is made up beyond is said.
namespace faultsim {
namespace {

constexpr double kNoChange = 1;  // Pa

/// One direction in which a table counts places, against the fault.
struct Direction {
  const std::vector<double>& places;
  std::array<double, 2> fault;  ///< m, low and high.
  const char* name;             ///< "depth".
  double low() const { return places.front(); }
  double high() const { return places.back(); }
};

std::vector<Direction> directions(const Scene& scene, std::size_t fault) {
  const FaultPressureTable& table = scene.faults[fault].pressure.profile;
  const TableExtent extent = table_extent(scene, fault);
  const bool by_depth = table.place == FaultPressureTable::Place::depth;
  std::vector<Direction> all = {
      {table.dip, extent.dip, by_depth ? "depth" : "down dip of its centre"}};
  if (!table.strike.empty()) all.push_back({table.strike, extent.strike, "along strike"});
  return all;
}

bool has_table(const Fault& fault) {
  return fault.pressure.rule == FaultPressureRule::table && !fault.pressure.profile.change.empty();
}

/// Whether a row or column of the table is 0, within a pascal, at all times: nothing is made up
/// beyond it.
bool is_zero_at(const FaultPressureTable& table, bool along_dip, bool at_end) {
  const std::size_t n_strike = std::max<std::size_t>(table.strike.size(), 1);
  const std::size_t at = !at_end ? 0 : along_dip ? table.dip.size() - 1 : n_strike - 1;
  for (std::size_t i = 0; i < table.change.size(); ++i) {
    const std::size_t place = i / table.time.size();
    if ((along_dip ? place / n_strike : place % n_strike) == at &&
        std::abs(table.change[i]) > kNoChange)
      return false;
  }
  return true;
}

/// What the table leaves out of its fault.
void remark_ends(const SceneReader& reader, Scene& scene, std::size_t fault) {
  const FaultPressureTable& table = scene.faults[fault].pressure.profile;
  constexpr double kSmall = 1e-3;  // m
  bool along_dip = true;
  for (const Direction& d : directions(scene, fault)) {
    // One place is the same everywhere, and said so.
    const bool many = d.places.size() > 1;
    std::string beyond;
    if (many && d.low() > d.fault[0] + kSmall && !is_zero_at(table, along_dip, false))
      beyond = metres(d.fault[0]) + " to " + metres(d.low());
    if (many && d.high() < d.fault[1] - kSmall && !is_zero_at(table, along_dip, true))
      beyond += (beyond.empty() ? "" : " and ") + metres(d.high()) + " to " + metres(d.fault[1]);
    along_dip = false;
    if (beyond.empty()) continue;
    scene.remarks.push_back(
        {reader.fault_pressure_key(fault, "csv"),
         concat("does not cover all of fault ", scene.faults[fault].name, ": from ", beyond, " (",
                d.name, ") the pressures at its ends are held")});
  }
}

/// That the table ends before the stages do.
void remark_last_time(const SceneReader& reader, Scene& scene, std::size_t fault,
                      std::optional<double> start) {
  const std::vector<StepEnd> steps = step_ends(scene);
  const double last = scene.faults[fault].pressure.profile.time.back();
  if (steps.empty() || last >= steps.back().time - kMetShare * steps.back().length) return;
  const auto when = [&](double time) {
    return start ? date_text(*start + time) : in_unit(time, Dimension::time, "year");
  };
  scene.remarks.push_back(
      {reader.fault_pressure_key(fault, "csv"),
       concat("ends at ", when(last), " and the stages of the scene at ", when(steps.back().time),
              ": the last pressures of fault ", scene.faults[fault].name, " are held")});
}

/// That the times of the table make many and most of the load steps.
void remark_added_steps(const SceneReader& reader, Scene& scene, std::size_t fault) {
  const std::vector<double>& turns = scene.faults[fault].pressure.profile.turns;
  const std::vector<StepEnd> steps = step_ends(scene);
  const auto n_all = std::ssize(steps);
  const auto n_added = std::ranges::count_if(steps, [](const StepEnd& s) { return s.added; });
  const auto n_own = std::ranges::count_if(steps, [&](const StepEnd& s) {
    return s.added && std::ranges::binary_search(turns, s.time);
  });
  constexpr long kMany = 50;
  if (n_own <= std::max(kMany, n_all - n_added)) return;
  scene.remarks.push_back(
      {reader.fault_pressure_key(fault, "csv"),
       concat("adds ", n_own, " load steps to the ", n_all - n_added,
              " of the stages, at the times between which the pressures of fault ",
              scene.faults[fault].name,
              " are not linear; a table with fewer times adds fewer, and \"turning_points\": "
              "\"report\" in /numerics adds none")});
}

}  // namespace

void check_fault_tables(SceneReader& reader, const Scene& scene) {
  if (!is_body_known(reader, scene)) return;  // faults of a mesh have their places in it
  if (!reader.sound("/faults") || !reader.sound("/fault_pressure")) return;
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    if (!has_table(scene.faults[f])) continue;
    for (const Direction& d : directions(scene, f)) {
      if (!(d.high() < d.fault[0]) && !(d.low() > d.fault[1])) continue;
      const std::string pointer = reader.fault_pressure_key(f, "csv");
      const std::string given =
          d.low() == d.high() ? metres(d.low()) : metres(d.low()) + " to " + metres(d.high());
      reader.problem(pointer,
                     concat(reader.as_given(pointer), " has pressures at ", given, " (", d.name,
                            "), but fault \"", scene.faults[f].name, "\" reaches from ",
                            metres(d.fault[0]), " to ", metres(d.fault[1])),
                     "give pressures at places on the fault");
    }
  }
}

void remark_fault_tables(SceneReader& reader, Scene& scene) {
  std::optional<double> start;
  for (std::size_t f = 0; f < scene.faults.size(); ++f) {
    if (!has_table(scene.faults[f])) continue;
    if (!start) start = start_date(reader, scene);
    remark_ends(reader, scene, f);
    remark_last_time(reader, scene, f, start);
    remark_added_steps(reader, scene, f);
  }
}

}  // namespace faultsim
