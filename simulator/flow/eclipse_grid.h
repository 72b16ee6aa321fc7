#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace faultsim {

/// A corner-point grid as its files have it: numbers and units of the file, depths downwards,
/// nothing checked but that the arrays can be read. simulator/corner_point makes a grid in metres
/// of it.
struct EclipseGrid {
  std::array<int, 3> size = {0, 0, 0};  ///< cells along i, j, k (GRIDHEAD).
  std::vector<float> coord = {};        ///< COORD: 6 a pillar: x, y, depth of two points on it.
  std::vector<float> zcorn = {};        ///< ZCORN: 8 a cell, rows of corners along i, then j, k.
  std::vector<int> active = {};         ///< ACTNUM, a cell each; none: all cells are active.
  std::string length_unit = {};         ///< GRIDUNIT: "METRES", "FEET", "CM"; "": not said.
  bool is_on_map = false;               ///< GRIDUNIT says MAP: MAPAXES is not to be applied.
  std::vector<float> map_axes = {};  ///< MAPAXES: a point on y, the origin, a point on x; or none.
  std::string map_unit = {};         ///< MAPUNITS, as length_unit.
  std::vector<std::array<int, 2>> connections = {};  ///< NNC1, NNC2: cells from 0, as they stand.
  int unit_system = 0;  ///< INTEHEAD: 1 METRIC, 2 FIELD, 3 LAB, 4 PVT-M; 0: in no file beside it.
  std::string unit_file = {};  ///< where INTEHEAD was: "CASE.INIT".
  std::vector<int> equilibrium_region =
      {};                              ///< EQLNUM of the INIT file, an active cell each; or none.
  std::vector<int> fluid_region = {};  ///< FIPNUM, likewise.
  std::vector<float> cell_depth = {};  ///< DEPTH, likewise, in units of unit_system.
};

/// Reads CASE.EGRID and, where they are, CASE.INIT and the head of the first restart file.
/// @param path  any of the files, or their name without ending (eclipse_files.h).
/// @throws InputError with all that is wrong: a grid that is missing or cut off, local grid
/// refinements, a radial grid, several coordinate systems, dual porosity or permeability; and where
/// this program was built without opm-common (reads_eclipse in eclipse_result.h).
EclipseGrid read_eclipse_grid(const std::filesystem::path& path);

/// Whether MAPAXES say nothing: six zeros, which programs write that have no map.
bool are_no_axes(const std::vector<float>& map_axes);

/// What is wrong with the axes of MAPAXES (of which there are six numbers), as in "has axes on the
/// map (MAPAXES) that are not at right angles to each other"; "": nothing.
std::string axes_misfit(const std::vector<float>& map_axes);

/// What a unit of length of the file is, and how that was decided.
struct EclipseLength {
  double metre = 1;         ///< m per unit of the file.
  std::string remark = {};  ///< "" where the files agree; else what they say and what was taken.
};

/// The unit of COORD and ZCORN. GRIDUNIT and INTEHEAD say the same, as a rule. Where they do not,
/// INTEHEAD decides, since programs that export grids write GRIDUNIT without converting; but where
/// `depth_ratio` equals the ratio of the two units to 1 %, the depths of cells do.
/// @param depth_ratio  the median of DEPTH of the INIT file over the depth of the cell in the grid
/// file, each in its own unit: 1 where both are in the unit of INTEHEAD; none: not known.
EclipseLength eclipse_length(const EclipseGrid& grid, std::optional<double> depth_ratio);

/// That median, of active cells by the mean of their corners' depths; none without DEPTH.
std::optional<double> depth_ratio(const EclipseGrid& grid);

/// METRES, FEET, CM in m; nothing for another word.
std::optional<double> eclipse_metre(const std::string& unit);

}  // namespace faultsim
