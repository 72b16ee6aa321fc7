#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "simulator/flow/eclipse_grid.h"

namespace faultsim::corner_point {

/// A straight line on which the corners of four columns of cells lie: two different points of it,
/// m, z up. A pillar whose points lie at one depth has one place in the map for all depths.
struct Pillar {
  Eigen::Vector3d top = Eigen::Vector3d::Zero();
  Eigen::Vector3d bottom = Eigen::Vector3d::Zero();

  /// Its place in the map at a height z, m, beyond its points as well.
  Eigen::Vector2d at(double z) const;
};

/// Where a corner of a cell is: towards greater i, greater j, and at its bottom.
struct CornerPlace {
  bool right = false, back = false, bottom = false;
};

/// Those of a cell's top.
inline constexpr std::array<CornerPlace, 4> kTopCorners = {
    {{false, false, false}, {true, false, false}, {false, true, false}, {true, true, false}}};

/// A corner-point grid: columns of cells between pillars, m, z up (negative below the datum), x and
/// y on the map. i runs fastest, then j, then k, all from 0; k counts downwards. i and j may be
/// left- or right-handed on the map.
/// @invariant corner_point_grid() sees to it: sizes fit, all numbers finite, no cell of an active
/// column has its bottom above its top (active ones are refused, inactive ones become flat).
struct CornerPointGrid {
  std::array<int, 3> size = {0, 0, 0};  ///< cells along i, j, k, each ≥ 1.
  std::vector<Pillar> pillars;          ///< (ni + 1)(nj + 1).
  std::vector<double> corner_z;         ///< 8 ni nj nk, m, in the order of ZCORN: corner_index().
  std::vector<char> is_active;          ///< ni nj nk.
  std::vector<int> equilibrium_region;  ///< EQLNUM, ni nj nk, 0 in inactive cells; or none.
  std::vector<int> fluid_region;        ///< FIPNUM, likewise.
  /// By EQLNUM or FIPNUM: why the one of a file is none here, "EQLNUM of the INIT file has ...".
  std::map<std::string, std::string> region_misfits;
  std::vector<std::array<int, 2>> connections;  ///< between cells that are no neighbours (NNC).
  std::vector<std::string> remarks;  ///< what was decided in reading it: units, place on the map.

  int n_columns() const { return size[0] * size[1]; }
  int n_cells() const { return n_columns() * size[2]; }
  int column(int i, int j) const { return i + size[0] * j; }
  int cell(int column, int k) const { return column + n_columns() * k; }
  /// (i, j) of a column.
  std::array<int, 2> place(int column) const { return {column % size[0], column / size[0]}; }
  int pillar(int i, int j) const { return i + (size[0] + 1) * j; }
  std::size_t corner_index(int column, int k, CornerPlace corner) const;
  double z(int column, int k, CornerPlace corner) const {
    return corner_z[corner_index(column, k, corner)];
  }
  /// The pillar of a column's corner; `bottom` does not matter.
  int pillar_of(int column, CornerPlace corner) const;
  /// A corner of a cell, on its pillar.
  Eigen::Vector3d corner(int column, int k, CornerPlace corner) const;
  /// Whether any cell of the column is active.
  bool has_active_cell(int column) const;
  /// Whether a cell has its bottom above its top, by more than a file's single precision makes of
  /// nothing at depths of kilometres, 1 mm.
  bool is_inverted(int column, int k) const;
  /// Mean of the heights of top and bottom over the four corners, m: 0 in collapsed cells.
  double thickness(int column, int k) const;
  /// The largest height of top over bottom at a corner, m.
  double largest_thickness(int column, int k) const;
};

/// The grid of a file's arrays: in metres (eclipse_length decides the unit), on the map (MAPAXES
/// applied as read_eclipse does, unless coordinates are on the map already), z up.
/// @param source  the name of the file, for messages.
/// @throws InputError with all that is wrong: arrays whose sizes do not fit, numbers that are none,
/// active cells that lie upside down, axes that are not at right angles, no active cell.
CornerPointGrid corner_point_grid(const EclipseGrid& file, const std::string& source);

/// read_eclipse_grid and the above.
CornerPointGrid read_corner_point_grid(const std::filesystem::path& path);

}  // namespace faultsim::corner_point
