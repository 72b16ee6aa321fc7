#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace faultsim {

using CellCorners = std::array<Eigen::Vector3d, 8>;  ///< of a hexahedron in VTK's order, m.

/// A cell of a flow grid, m, z upwards (z = −depth): an upright box, or a hexahedron within it. A
/// hexahedron is the six tetrahedra around its diagonal from corner 0 to 6; so neighbours that
/// share four corners share the face, plane or not. @invariant low < high, the box is the smallest
/// one.
struct FlowCell {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  std::optional<CellCorners> corners = {};  ///< of a hexahedron, of either handedness; none: a box.
};

enum class FlowQuantity { pressure, temperature };

/// Pressures or temperatures of a flow simulator, cell by cell and report by report.
struct FlowField {
  std::vector<FlowCell> cells;  ///< in the order of the file.
  std::vector<double> date;     ///< s since 1970-01-01, strictly increasing, at least one.
  Eigen::MatrixXd value = {};   ///< absolute, Pa or K, n_cells x n_reports, all finite and >= 0.
  /// What was made of the file that it does not say itself, as the rest of a sentence about it:
  /// "has no depth: its values hold at all depths".
  std::vector<std::string> notes = {};
};

/// The smallest cell around eight corners: a box where they are those of one.
FlowCell flow_cell_around(const CellCorners& corners);

/// The field in other coordinates: what lies at `origin` (m) is at (0, 0), and what is towards
/// `azimuth` (rad, from the field's y clockwise) is along y. Depths stay.
FlowField placed(const FlowField& field, const std::array<double, 2>& origin, double azimuth);
/// Of that field the cells whose boxes overlap the box from low to high, m, which does not copy the
/// others: for what looks at a part of a large field. There may be none.
FlowField placed_within(const FlowField& field, const std::array<double, 2>& origin, double azimuth,
                        const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// What speaks against the unit of the first report's pressures: the median over the cells of
/// p / (10 kPa/m · depth) is far from hydrostatic, above 4 (psi read as bar: 14.5) or below 0.1.
/// "" = nothing; else a warning with the median, the likely cause and the cure. Cells at or above
/// depth 0 say nothing.
std::string pressure_doubt(const FlowField& field);

/// By how much a field differs from its mirror image about y = 0: the largest difference between
/// the values of a cell and of its image at any report, over the largest value. Nothing where the
/// grid is not its own mirror image, to a millimetre in every corner.
std::optional<double> asymmetry(const FlowField& field);

}  // namespace faultsim
