#pragma once

#include <array>
#include <utility>
#include <vector>

#include "simulator/mesh/mesh_spec.h"

namespace faultsim {

/// The part of a grid plane on which a fault splits nodes, in numbers of grid lines.
struct FaultWindow {
  /// Lines [first, second) per axis; one line on the axis across it.
  std::array<std::pair<int, int>, 3> lines;
  double share = 1;  ///< of its nodes that split: π/4 for an ellipse.
};

/// What a linear bulk is to the factorisation: a block of grid nodes and the faults in it.
struct GridShape {
  std::array<int, 3> n_lines = {1, 1, 1};  ///< nodes per axis; plane strain has 1 in y.
  int unknowns_per_node = 3;               ///< 2 in plane strain.
  std::vector<FaultWindow> faults;
  int n_loads = 0;  ///< right-hand sides: unit loads, and components of observation points.

  double n_nodes() const { return 1.0 * n_lines[0] * n_lines[1] * n_lines[2]; }
  double n_cells() const;
  double n_jump() const;  ///< unknowns on the faults.
};

/// Size of the sparse Cholesky factor with the jumps ordered last (docs/model.md, 8).
struct FactorSize {
  double entries = 0;         ///< as stored: a supernode is a full rectangle.
  double flops = 0;           ///< additions and multiplications.
  double largest_update = 0;  ///< entries of the largest block that a front adds to those above.
  double heaviest_way = 0;  ///< entries on the way from a leaf of the elimination tree to its root,
                            ///< the jumps' dense block left out.
};

/// Counts the factor of a grid under nested dissection: a block of nodes is cut in two by its
/// smallest grid plane until a few nodes are left. With s unknowns on the cut, and below them the r
/// of the planes around the block and of the jumps that touch it,
///
///   entries += s (s + r),   flops += ((s + r)³ − r³)/3
///
/// and last the dense block of the jumps. Takes 0.1 ms for 10^5 nodes.
FactorSize dissected_factor(const GridShape& shape);

/// Predicted cost of one operator.
struct OperatorCost {
  double seconds = 0;       ///< on one core of the calibration machine (results/plan).
  double factor_bytes = 0;  ///< stays where the bulk must (creep).
  double kept_bytes = 0;    ///< mesh and lists that stay with it.
  double peak_bytes = 0;    ///< while it is built, the factor included, the program not.
};
OperatorCost operator_cost(const GridShape& shape);

/// Predicted cost of an influence block (model/influence.h) on top of the operator's: each cell
/// goes up a way of the elimination tree, 2 operations per entry.
struct InfluenceCost {
  double seconds = 0;  ///< on one core of the calibration machine, the factor given.
  double bytes = 0;    ///< of the block, in memory and on disk.
  double peak_bytes =
      0;  ///< while it is built: the factor, what stays with it, H, block and workspace.
};
InfluenceCost influence_cost(const GridShape& shape, double n_cells, double n_observed);

inline constexpr double kProgramBytes = 23e6;  ///< the program and its libraries.

}  // namespace faultsim
