#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

/// A corner-point grid as columns of cells between pillars, rebuilt from the centres of its cells:
/// columns and pillars by indexed_columns() or followed_columns(), then set_borders(), find_dips()
/// and cells_of_columns(). Depths are downwards, m.
namespace faultsim {

/// A line that goes down through a grid, upright or sloping.
struct SlopingLine {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();    ///< x, y at `depth`, m.
  double depth = 0;                                ///< m
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();  ///< m sideways per m downwards.

  Eigen::Vector2d operator()(double at_depth) const { return at + (at_depth - depth) * lean; }
};

/// What is known of a cell: its centre, and which layer it is of.
struct CellCentre {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< m
  double depth = 0;                              ///< m
  int layer = 0;                                 ///< grows downwards; 1 apart: they touch.
  double thickness = 0;                          ///< m; 0: not known.
  std::size_t point = 0;                         ///< its number in the table.

  bool touches(const CellCentre& above) const { return layer == above.layer + 1; }
};

/// How deep the top or bottom of a cell lies on the axis of its column.
struct CellBorder {
  int layer = 0;     ///< below it: so columns know which borders they share.
  double depth = 0;  ///< m
};

/// Cells that lie on each other.
struct CellColumn {
  std::vector<CellCentre> cells;         ///< downwards, at least one.
  SlopingLine axis = {};                 ///< through their centres; upright through a single one.
  std::vector<int> pillars = {};         ///< numbers of those around it, in order; at least three.
  std::vector<CellBorder> borders = {};  ///< downwards (set_borders()).
  std::vector<std::size_t> tops = {};    ///< per cell, of `borders`; its bottom is the next one.
  Eigen::Vector2d dip = Eigen::Vector2d::Zero();  ///< m down per m (find_dips()).

  double height() const { return borders.back().depth - borders.front().depth; }
};

/// An edge that columns share.
struct CellPillar {
  SlopingLine line;
  std::vector<int> columns;  ///< numbers of those around it.
};

/// Columns and the pillars between them.
struct ColumnGrid {
  std::vector<CellColumn> columns;
  std::vector<CellPillar> pillars;
  /// All columns have four pillars, in the order of i and j: (0, 0), (1, 0), (1, 1), (0, 1).
  bool is_indexed = false;
};

/// A column of cells with its axis, the line of least squares.
/// @param cells  at least one, downwards.
CellColumn column_of(std::vector<CellCentre> cells);

/// How deep two columns lie where they have the same layers.
struct CommonDepth {
  double own = 0, other = 0;  ///< means over the centres, m.
  bool is_any = false;        ///< they have a layer in common.
};
CommonDepth common_depth(const CellColumn& column, const CellColumn& other);

/// Sets the borders of cells: half the thickness above and below each centre where that is known.
/// Elsewhere cells that touch lie side by side (touching_cells()), and one alone takes the median
/// of what its layer has in other columns, or of all. Borders of cells that touch are one, half way
/// between the two, and so are those that lie over each other, or with less between than a quarter
/// of the thinner cell: there a layer pinches out.
/// @pre some cells touch, or thicknesses are known.
void set_borders(std::vector<CellColumn>& columns);

}  // namespace faultsim
