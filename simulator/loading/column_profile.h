#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_operator.h"

namespace faultsim {

/// A strike column of a fault as profiles down dip, prepared once per operator.
///
/// Nodal tractions are forces over lumped areas, that is, means over the nodes' dual cells, which
/// end half way to the neighbours. Integrals over a window are therefore sums of forces; the cells
/// that it cuts are sloped towards their neighbours. Interpolating nodal tractions linearly would
/// smear a corner's stress peak a second time (measured: results/measures). Slip is a
/// displacement and linear between nodes; it falls to 0 at unsplit ends (docs/model.md, section 7).
struct Column {
  int fault;
  double width;                  ///< m.
  std::vector<int> nodes;        ///< fault nodes down dip.
  std::vector<double> position;  ///< s of each node, m from the column's first grid point.
  std::vector<double> edge;      ///< s of the ends of the dual cells, m; nodes + 1.
  double tip_before, tip_after;  ///< s of the unsplit ends (slip 0); NaN where the column is cut by
                                 ///< the body's boundary instead.
  bool strike_edge = false;      ///< the fault ends next to it along strike, inside the rock.

  double share(std::size_t i) const { return edge[i + 1] - edge[i]; }  ///< of node i, m.
  /// The longest extent that slip could reach, m.
  double length() const;
};

/// The j-th column of a fault; without nodes if nothing is split there.
Column make_column(const OperatorFault& fault, int fault_index, int j);

/// The most loaded window of a column.
struct WindowIndex {
  double critical_index = 0;  ///< χ̄: ∫|t'_T| ds / ∫τ_L ds over the window.
  double n_cells = 0;         ///< dual cells in the window, parts counted as parts.
};

/// χ̄ of one column: maximum over windows of `length`, or the whole column when it is shorter.
/// Exact for its profiles: the sum of each dual cell kept, with the lesser of the slopes to the
/// neighbours (0 at extremes and ends); at most the largest nodal ratio.
/// @param shear, strength  per fault node, Pa; strength > 0.
WindowIndex window_critical_index(const Column& column, const Eigen::VectorXd& shear,
                                  const Eigen::VectorXd& strength, double length);

/// Down-dip length of the column where the nodal profile exceeds a threshold, linear between nodes,
/// constant over the end half cells.
double length_above(const Column& column, const Eigen::VectorXd& profile, double threshold);

/// Where slip exceeds a tolerance in a column, and whether the cells can tell that it reaches a
/// length. The end of a stretch of slip may lie elsewhere by half of the cell that it is in.
struct SlipExtent {
  double longest = 0, total = 0;  ///< m, longest stretch and all together, linear between nodes.
  bool reaches = false;           ///< longest ≥ the length asked for.
  bool surely = false;  ///< so it would be with both ends further in, and ≥ kLeastCells cells slip.
  bool resolved = true;  ///< surely, or it would not with the ends of any stretch further out.
};

/// Whole cells that a stretch must have for its length to be the rock's and not the mesh's: a
/// stretch of just the activation length is resolved by cells of a quarter of it.
inline constexpr std::size_t kLeastCells = 4;

/// @param slip  |g_T| since the reference time, m, per node of the column.
SlipExtent slip_extent(const Column& column, const std::vector<double>& slip, double tolerance,
                       double length);

}  // namespace faultsim
