#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Sensitivity on a full factorial grid, where nothing is estimated: every combination is there, so
/// that indices are finite sums. They are of the levels given, each as likely as the others.
namespace faultsweep {

/// Of one factor, both in [0, 1].
struct ExactIndices {
  double first = 0;  ///< S = Var E[y | x_i] / Var y.
  double total = 0;  ///< T = E[Var(y | x_others)] / Var y.
};

/// Of one output.
struct GridIndices {
  double mean = 0, variance = 0;      ///< over all rows; variance: the mean of squares.
  std::vector<ExactIndices> factors;  ///< zeros where the output is the same in every row.
};

/// The rows of a full factorial grid, in any order: which combination of levels each of them is.
class FullGrid {
 public:
  struct Made;

  /// @param levels  [factor][row]: the level's number, from 0; a factor has as many levels as its
  ///                largest number says.
  /// Refused where a combination is missing or there twice, or there is no row. Cost: rows ·
  /// factors.
  static Made make(std::span<const std::vector<std::uint32_t>> levels);

  /// The decomposition of Sobol' (1993) as means over levels. With y centred, of a factor of L
  /// levels with means a_l, and lines of L rows along it with means b,
  ///
  ///   S = Σ_l a_l² / L / Var y,   T = 1 − mean(b²) / Var y.
  ///
  /// Cost: rows · factors, each row read in the grid's order.
  /// @param values  one per row. Nothing where one of them is not finite.
  std::optional<GridIndices> indices(std::span<const double> values) const;

  std::size_t n_rows() const { return place_.size(); }

 private:
  std::vector<std::size_t> n_levels_;
  std::vector<std::uint32_t> place_;  ///< of each row in the grid, the last factor fastest.
};

/// A grid, or why the rows are none.
struct FullGrid::Made {
  std::optional<FullGrid> grid;
  std::string refusal;  ///< "" where there is a grid.
};

/// Indices of several outputs together, each counting as much as it varies: Σ V S / Σ V of every
/// factor (Lamboni, Monod & Makowski 2011). Zeros where no output varies.
/// @param outputs  of the same grid; not empty.
std::vector<ExactIndices> aggregated(std::span<const GridIndices> outputs);

}  // namespace faultsweep
