#include <cmath>

#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/stored_line.h"
#include "simulator/common/errors.h"
#include "simulator/figure/depth_chart.h"

namespace faultsim::case_figures {
namespace {

/// Of a face the state that at least half of its corners have, if not of sticking: it moves where
/// half of them do, and is open where half of those are.
double state_of(const std::vector<int>& face, const StoredFields& now) {
  std::size_t n_moving = 0, n_open = 0;
  for (const int point : face) {
    const auto state = static_cast<FaultState>(now.state[static_cast<std::size_t>(point)]);
    n_moving += state == FaultState::stick ? 0U : 1U;
    n_open += state == FaultState::open ? 1U : 0U;
  }
  const FaultState state = 2 * n_moving < face.size() ? FaultState::stick
                           : 2 * n_open < n_moving    ? FaultState::slip
                                                      : FaultState::open;
  return static_cast<double>(state);
}

/// What is shown at a point, in the unit of the map. @pre not its state.
double shown_at(const StoredFields& now, Eigen::Index point, MapField show) {
  if (show == MapField::slip)
    return std::hypot(now.slip(1, point), now.slip(2, point)) / kMillimetre;
  if (show == MapField::pressure) return now.fault_pressure_change[point] / kBarInPascal;
  return now.critical_index[point];
}

/// The mean of a face's corners, or its state.
double value_of(const std::vector<int>& face, const StoredFields& now, MapField show) {
  if (show == MapField::state) return state_of(face, now);
  double sum = 0;
  for (const int point : face) sum += shown_at(now, point, show) / static_cast<double>(face.size());
  return sum;
}

/// How the map looks, and the beginning of its title: "χ on".
struct MapLook {
  figure::FaceColours colours;
  const char* on;
  const char* of;
};
MapLook look_of(MapField show) {
  using Kind = figure::FaceColours::Kind;
  switch (show) {
    case MapField::chi:
      return {{}, "χ on", "χ of"};
    case MapField::slip:
      return {{Kind::amount, "slip, mm"}, "Slip on", "Slip of"};
    case MapField::state:
      return {{Kind::state, ""}, "State of", "State of"};
    case MapField::pressure:
      return {{Kind::change, "Δp, bar"}, "Pressure change in", "Pressure change in"};
  }
  throw_internal("known field of a map", "", __FILE__, __LINE__);
}

/// A column of faces per load step: what a fault in plane strain does in time.
void add_time_map(const Chosen& chosen, std::size_t f, figure::FaultMap& map) {
  const FieldSource& file = *chosen.picture.fields;
  const StoredFault& fault = file.faults()[f];
  for (std::size_t entry = 0; entry < file.steps().size(); ++entry) {
    const double from = time_of(chosen.result(), file.times()[entry == 0 ? 0 : entry - 1]);
    const double to = time_of(chosen.result(), file.times()[entry]);
    if (!(to > from)) continue;
    const StoredFields now = file.fields(f, entry);
    for (const std::vector<int>& face : fault.faces) {
      const Eigen::Index a = face.front(), b = face.back();
      const double top = -fault.points(2, a), base = -fault.points(2, b);
      const double value = value_of({face.front(), face.back()}, now, chosen.request.show);
      map.cells.push_back({{{from, top}, {to, top}, {to, base}, {from, base}}, value, false});
    }
  }
  map.across = "time, " + time_unit_text(chosen.picture);
}

/// Faces at one step, and which of them slide in it or are open.
void add_plane_map(const StoredFault& fault, const StoredFields& now, MapField show,
                   figure::FaultMap& map) {
  const DipLines lines = dip_lines(fault);
  for (const std::vector<int>& face : fault.faces) {
    figure::FaultCell cell;
    std::size_t n_moving = 0;
    for (const int point : face) {
      cell.corners.push_back({lines.along(point), -fault.points(2, point)});
      n_moving += now.state[point] == 0 ? 0U : 1U;
    }
    cell.value = value_of(face, now, show);
    // A map of states needs no outlines.
    cell.is_marked = 2 * n_moving >= face.size() && show != MapField::state;
    map.cells.push_back(std::move(cell));
  }
  map.across = along_strike_words(lines) + ", m";
  if (show != MapField::state)
    map.marked = "slips or is open in this step (half of a face's corners or more)";
}

/// Widens the scale to hold what the fault's faces show at all load steps that were kept.
void hold_all(const FieldSource& file, std::size_t fault, MapField show,
              figure::FaceColours& colours) {
  for (std::size_t entry = 0; entry < file.steps().size(); ++entry) {
    const StoredFields now = file.fields(fault, entry);
    for (const std::vector<int>& face : file.faults()[fault].faces)
      colours.hold(value_of(face, now, show));
  }
}

/// Makes the scale of slips and pressures one that maps of other load steps have too, so that they
/// can be compared by colour, and of the case before a change.
void set_scale(const Chosen& chosen, std::size_t fault, figure::FaceColours& colours) {
  const MapField show = chosen.request.show;
  if (show != MapField::slip && show != MapField::pressure) return;
  hold_all(*chosen.picture.fields, fault, show, colours);
  const auto before = original_fault(chosen);
  if (before) hold_all(*chosen.picture.original->fields, before->fault, show, colours);
  const bool is_of_all = chosen.result().plane_strain && !before;  // the map has all steps itself
  if (!is_of_all) colours.same = same_scale_words(chosen.picture, before.has_value());
}

}  // namespace

std::string draw_fault_map(Chosen chosen) {
  const std::size_t f = stored_fault(chosen);
  figure::FaultMap map;
  map.bands = compartments_beside(chosen.scene(), chosen.fault);
  map.remark = subject_of(chosen.picture);
  const MapLook look = look_of(chosen.request.show);
  map.colours = look.colours;
  set_scale(chosen, f, map.colours);
  if (chosen.result().plane_strain) {
    map.title = concat(look.of, " fault ", chosen.fault_name(), " against depth and time");
    add_time_map(chosen, f, map);
  } else {
    const std::size_t entry = stored_entry(chosen);
    map.title = concat(look.on, " fault ", chosen.fault_name(), ": ", moment_text(chosen));
    add_plane_map(chosen.picture.fields->faults()[f], chosen.picture.fields->fields(f, entry),
                  chosen.request.show, map);
  }
  return figure::draw(map);
}

}  // namespace faultsim::case_figures
