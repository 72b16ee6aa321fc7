#pragma once

#include <string>
#include <vector>

#include "campaign/render/answer.h"
#include "simulator/result/result.h"

/// Places of faults, with the pressures beside them, as columns of answers.
namespace faultsweep {

/// What the pressures of the regions beside a place are.
enum class RegionPressures {
  at_depth,  ///< of the compartment, at the depth of the place.
  of_cells,  ///< of a flow field: of its cells beside the place.
  means,     ///< the same of results of before numerics 7: the mean change of the compartment.
};
/// Whether cases have a flow field, by the text of JSON documents: their scenes, or what varies.
bool has_flow_field(const std::string& document);
/// @param oldest  numerics version of the results in question.
RegionPressures region_pressures(bool has_field, int oldest);
/// A sentence: what "Δp" and "p" in the columns are.
std::string pressure_note(RegionPressures kind);

/// The keys of a place: depth, then change and absolute pressure of the side that changed more,
/// then of both sides with the names of their regions, and the change in the fault.
/// @param group  the object of a JSON row in which they stand; "" = the row.
/// @param sides  how much the columns of both sides are needed; the leading ones are wanted.
std::vector<AnswerColumn> place_columns(RegionPressures kind, const std::string& group, Need sides);
/// One for each column, behind the cells that the row has; empty ones for nullptr.
void add_place(double depth, const faultsim::SidePressures* pressures,
               std::vector<AnswerCell>& row);
/// The load step of an onset, then the keys of its place.
std::vector<AnswerColumn> onset_columns(RegionPressures kind, const std::string& group, Need sides);
void add_onset(const faultsim::FaultOnset* onset, std::vector<AnswerCell>& row);

}  // namespace faultsweep
