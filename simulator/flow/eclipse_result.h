#pragma once

#include <filesystem>

#include "simulator/flow/flow_field.h"

namespace faultsim {

/// Reads pressures (PRESSURE) or temperatures (TEMP) of the active cells of a grid in Eclipse's
/// formats, with the reports of its restart files. Units are those that the files say: METRIC,
/// FIELD or LAB of the restarts, and for lengths as eclipse_length() has it, with a note where
/// GRIDUNIT contradicts them. Coordinates are those of the map, as MAPAXES says where the grid has
/// it and its coordinates are not on the map already (GRIDUNIT); a note says which of the two it
/// was. Cells without volume are left out; connections between cells that do not touch and throws
/// of faults do not matter here.
/// @param path  any of the files, or their name without ending (eclipse_files.h).
/// @throws InputError with all that is wrong: a grid or restart that is missing, cut off or of
/// another grid, local grid refinements, radial grids, reports without the values or out of order,
/// values that are none; and where this program was built without opm-common.
FlowField read_eclipse(const std::filesystem::path& path, FlowQuantity quantity);

/// Whether this program can read them.
bool reads_eclipse();

}  // namespace faultsim
