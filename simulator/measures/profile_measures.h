#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/model/fault_profile.h"

namespace faultsim {

/// The most loaded window of a profile.
struct WindowIndex {
  double critical_index = 0;  ///< χ̄: ∫|t'_T| ds / ∫τ_L ds over the window.
  double n_cells = 0;         ///< dual cells in the window, parts counted as parts.
};

/// χ̄ of one profile (docs/model.md, section 7): maximum over windows of `length`, or the whole
/// profile when it is shorter. Integrals over a window are sums of forces, of which a cut dual cell
/// is sloped towards its neighbours: the sum of each cell is kept, with the lesser of the slopes (0
/// at extremes and ends). Interpolating nodal tractions linearly would smear a corner's stress peak
/// a second time (measured: results/measures). At most the largest ratio of a sample.
///
/// Where windows may begin and end is found once, for any number of loads.
class WindowSearch {
 public:
  /// @pre profile outlives this.
  WindowSearch(const Profile& profile, double length);
  /// @param shear, strength  per fault node, Pa; shear ≥ 0, strength > 0.
  WindowIndex most_loaded(const Eigen::VectorXd& shear, const Eigen::VectorXd& strength) const;

 private:
  /// A way from a place into the dual cell that it lies in, m from the cell's ends.
  struct Cut {
    std::size_t cell;
    double from_start, to_end;
  };
  /// A place from which on windows begin and end in the same two dual cells.
  struct Place {
    double begin;    ///< s of the window's start, m.
    Cut start, end;  ///< the window's.
    double bulge;    ///< ⅛ of the squared length to the next place, m2.
  };
  struct Cell;
  std::vector<Cell> cells(const Eigen::VectorXd& shear, const Eigen::VectorXd& strength) const;
  Place place(std::size_t first, std::size_t last, double begin, double end) const;

  const Profile& profile_;
  double window_;
  std::vector<double> middle_distance_;  ///< m, between dual cells i and i + 1.
  std::vector<Place> places_;  ///< from the first window to the last; none: one sample between
                               ///< faces of the body.
};

/// Length of the profile where a nodal field exceeds a threshold, linear between samples, constant
/// over the end half cells.
double length_above(const Profile& profile, const Eigen::VectorXd& values, double threshold);

/// Where slip exceeds a tolerance in a profile, and whether the cells can tell that it reaches a
/// length. The end of a stretch of slip may lie elsewhere by half of the cell that it is in.
struct SlipExtent {
  double longest = 0, total = 0;  ///< m, longest stretch and all together, linear between samples.
  bool reaches = false;           ///< longest ≥ the length asked for.
  bool surely = false;  ///< so it would be with both ends further in, and ≥ kLeastCells cells slip.
  bool resolved = true;  ///< surely, or it would not with the ends of any stretch further out.
};

/// Whole cells that a stretch must have for its length to be the rock's and not the mesh's: a
/// stretch of just the activation length is resolved by cells of a quarter of it.
inline constexpr std::size_t kLeastCells = 4;

/// @param slip  |g_T| since the reference time, m, per fault node.
SlipExtent slip_extent(const Profile& profile, const Eigen::VectorXd& slip, double tolerance,
                       double length);

}  // namespace faultsim
