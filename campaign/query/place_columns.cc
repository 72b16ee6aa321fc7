#include "campaign/query/place_columns.h"
#include "campaign/common/names.h"

#include <limits>

namespace faultsweep {

bool has_flow_field(const std::string& document) {
  // As a key of a scene, or at the beginning of a pointer into one.
  return document.find("\"pressure_field\"") != std::string::npos ||
         document.find("/pressure_field") != std::string::npos;
}

RegionPressures region_pressures(bool has_field, int oldest) {
  constexpr int kOfCells = 7;  // since that numerics version
  if (!has_field) return RegionPressures::at_depth;
  return oldest < kOfCells ? RegionPressures::means : RegionPressures::of_cells;
}

std::string pressure_note(RegionPressures kind) {
  const std::string side =
      " of the compartment that touches the fault there, on the side that "
      "changed more";
  switch (kind) {
    case RegionPressures::at_depth:
      return "Δp, p: change, and absolute pressure at the depth beside," + side;
    case RegionPressures::of_cells:
      return "Δp, p: change by the flow field's cells beside the place, and absolute pressure at "
             "its depth," +
             side;
    case RegionPressures::means:
      return "mean Δp, mean p: some results are from an older version, which for a flow field gave "
             "the mean change over the compartment, not the value at the place;" +
             side;
  }
  return "";
}

std::vector<AnswerColumn> place_columns(RegionPressures kind, const std::string& group,
                                        Need sides) {
  const std::string mean = kind == RegionPressures::means ? "mean " : "";
  const ShownUnit metre = shown_unit(Dimension::length), bar = shown_unit(Dimension::pressure);
  return {{"depth_m", "depth", metre, 5, Need::wanted, group},
          {"change_pa", mean + "Δp", bar, 4, Need::wanted, group},
          {"absolute_pa", mean + "p", bar, 4, Need::wanted, group},
          {"region_minus", "minus side", {}, 4, sides, group},
          {"change_minus_pa", mean + "Δp minus side", bar, 4, sides, group},
          {"absolute_minus_pa", mean + "p minus side", bar, 4, sides, group},
          {"region_plus", "plus side", {}, 4, sides, group},
          {"change_plus_pa", mean + "Δp plus side", bar, 4, sides, group},
          {"absolute_plus_pa", mean + "p plus side", bar, 4, sides, group},
          {"change_in_fault_pa", "Δp in fault", bar, 4, sides, group}};
}

void add_place(double depth, const faultsim::SidePressures* pressures,
               std::vector<AnswerCell>& row) {
  constexpr std::size_t kColumns = 10;
  if (pressures == nullptr) {
    row.resize(row.size() + kColumns);
    return;
  }
  const faultsim::SidePressures& p = *pressures;
  append(row, {depth, leading_change(p), leading_absolute(p), p.region_minus, p.change_minus,
               p.absolute_minus, p.region_plus, p.change_plus, p.absolute_plus, p.change_in_fault});
}

std::vector<AnswerColumn> onset_columns(RegionPressures kind, const std::string& group,
                                        Need sides) {
  std::vector<AnswerColumn> columns = place_columns(kind, group, sides);
  columns.insert(columns.begin(), {"step", "from step", {}, 4, Need::wanted, group});
  return columns;
}

void add_onset(const faultsim::FaultOnset* onset, std::vector<AnswerCell>& row) {
  row.push_back(onset != nullptr ? AnswerCell(onset->step) : AnswerCell());
  add_place(onset != nullptr ? onset->depth : std::numeric_limits<double>::quiet_NaN(),
            onset != nullptr ? &onset->pressures : nullptr, row);
}

}  // namespace faultsweep
