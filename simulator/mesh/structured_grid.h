#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "simulator/common/errors.h"
#include "simulator/mesh/mesh_spec.h"

namespace faultsim {

/// A fault on a grid plane: all points of line `plane` of axis `axis`.
struct GridFault {
  std::string name;
  size_t axis = 0;         ///< 0, 1, 2: the grid axis across the fault.
  size_t plane = 0;        ///< index of its grid line on that axis; inside the body.
  size_t column_axis = 1;  ///< grid axis of the columns (along strike).
  size_t row_axis = 2;     ///< grid axis of the rows (down dip).
  Eigen::Vector3d normal, strike,
      dip;  ///< as in FaultNode; normal has a positive `axis` component.
  std::vector<char>
      split;  ///< per point (column line * number of row lines + row line): 1 = splits.
};

/// Mapped structured hexahedra before the faults are cut. Point (i, j, k) of the lines is at
/// i + n_x (j + n_y k); cells likewise with one less per axis.
struct StructuredGrid {
  GridLines lines;                        ///< m, reference (unsheared) coordinates.
  std::vector<Eigen::Vector3d> position;  ///< m, per point.
  std::vector<int> material;              ///< per cell.
  std::vector<int> region;                ///< per cell, -1 = none.
  std::vector<double> region_fraction;    ///< per cell.
  std::vector<GridFault> faults;
  std::array<bool, 3> tied = {false, false, false};
  bool plane_strain = false;  ///< one cell in y; ties y.

  size_t n_lines(size_t axis) const { return lines[axis].size(); }
  size_t n_points() const { return n_lines(0) * n_lines(1) * n_lines(2); }
  size_t n_cells() const { return (n_lines(0) - 1) * (n_lines(1) - 1) * (n_lines(2) - 1); }
  size_t point(const std::array<size_t, 3>& at) const {
    return at[0] + n_lines(0) * (at[1] + n_lines(1) * at[2]);
  }
  size_t cell(const std::array<size_t, 3>& at) const {
    return at[0] + (n_lines(0) - 1) * (at[1] + (n_lines(1) - 1) * at[2]);
  }
};

/// Cuts the faults and ties the faces.
///
/// The minus copy of a duplicated node keeps the grid's number (point number), the plus copies
/// follow after all points, fault by fault. Columns ascend along the column axis, rows go down dip.
/// In plane strain a fault has one column, its faces have both ends of an edge twice (corners 0 and
/// 3, 1 and 2 are one point), and areas are divided by the thickness.
///
/// Throws InputError where opposite tied faces do not match (shape, or a fault cuts one of them
/// only) or a fault splits no node.
Mesh cut_faults(StructuredGrid grid);
/// The same without cells and boundary, in a time of the faults' size beside that of the points:
/// for a grid whose mesh has the topology of `like`; nothing where it has not. Materials are
/// compared, regions are not. Grids that are tied across must match, which is not looked at again.
std::optional<Mesh> cut_as(const Mesh& like, StructuredGrid grid);

/// A problem when more than kMaxCells cells are asked for.
std::vector<Problem> grid_size_problems(const GridLines& lines);

inline constexpr double kMaxCells = 1e8;  ///< far beyond what a direct factor holds; ints suffice.

/// check_quality(), thrown as InputError.
void refuse_bad_cells(const Mesh& mesh);

}  // namespace faultsim
