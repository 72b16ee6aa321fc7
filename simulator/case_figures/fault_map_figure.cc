#include "simulator/case_figures/field_section.h"
#include "simulator/case_figures/stored_line.h"
#include "simulator/common/errors.h"
#include "simulator/figure/depth_chart.h"

namespace faultsim::case_figures {
namespace {

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
      const double value = (now.critical_index[a] + now.critical_index[b]) / 2;
      map.cells.push_back({{{from, top}, {to, top}, {to, base}, {from, base}}, value, false});
    }
  }
  map.across = "time, " + time_unit_text(chosen.picture);
}

/// Faces at one step, and which of them slide in it or are open.
void add_plane_map(const StoredFault& fault, const StoredFields& now, figure::FaultMap& map) {
  for (const std::vector<int>& face : fault.faces) {
    figure::FaultCell cell;
    std::size_t n_moving = 0;
    for (const int point : face) {
      cell.corners.push_back({fault.points(1, point), -fault.points(2, point)});
      cell.value += now.critical_index[point] / static_cast<double>(face.size());
      n_moving += now.state[point] == 0 ? 0U : 1U;
    }
    cell.is_marked = 2 * n_moving >= face.size();
    map.cells.push_back(std::move(cell));
  }
  map.across = "along strike, m";
  map.marked = "slips or is open in this step (half of a face's corners or more)";
}

}  // namespace

std::string draw_fault_map(Chosen chosen) {
  const std::size_t f = stored_fault(chosen);
  figure::FaultMap map;
  map.bands = compartments_beside(chosen.scene(), chosen.fault);
  map.remark = subject_of(chosen.picture);
  if (chosen.result().plane_strain) {
    map.title = concat("χ of fault ", chosen.fault_name(), " against depth and time");
    add_time_map(chosen, f, map);
  } else {
    const std::size_t entry = stored_entry(chosen);
    map.title = concat("χ on fault ", chosen.fault_name(), ": ", moment_text(chosen));
    add_plane_map(chosen.picture.fields->faults()[f], chosen.picture.fields->fields(f, entry), map);
  }
  return figure::draw(map);
}

}  // namespace faultsim::case_figures
