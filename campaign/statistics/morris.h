#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "campaign/statistics/intervals.h"

namespace faultsweep {

/// Of one parameter (Morris 1991; μ*: Campolongo, Cariboni & Saltelli 2007), in units of the output
/// per whole range of the parameter.
struct ElementaryEffects {
  Estimate mean;            ///< μ, with its sign.
  Estimate mean_magnitude;  ///< μ*, of the effects without theirs: how much it matters.
  Estimate deviation;       ///< σ: how much it depends on the others, or on where it stands.
  long n = 0;               ///< effects that are known, one per trajectory at most.
};

/// Rows of a Morris design: trajectories one after the other, D + 1 rows each, of which each
/// differs from the one before in one parameter, every parameter in turn.
class MorrisDesign {
 public:
  struct Made;

  /// @param x     [parameter][row], in any unit: it says which parameter moves, and which way.
  /// @param step  Δ > 0, how far a move goes as a share of the range: p / (2 (p − 1)) on p levels.
  /// Refused where rows are no such trajectories.
  static Made make(std::span<const std::vector<double>> x, double step);

  /// Effects (y after − y before) / ±Δ, one per parameter and trajectory, which are independent of
  /// each other; of r of them
  ///
  ///   μ = mean(d),   μ* = mean(|d|),   σ² = Σ (d − μ)² / (r − 1).
  ///
  /// Bounds of μ and μ*: Student's t with r − 1 degrees of freedom; not below 0 of μ*. Bounds of σ:
  /// ln σ ± t √((κ − (r − 3) / r) / (r − 1)) / 2, with the kurtosis κ of the effects, which need
  /// not be normal (Bonett 2006), and r / 4 degrees of freedom; standard error: σ times that
  /// without t. 95 % intervals hold 93 to 98 % from kFewestTrajectories on, of σ from
  /// kFewestForDeviation on (results/coverage). Of fewer than two effects nothing is bounded, of
  /// none all is NaN; where effects differ by rounding only (1e-12 of the largest) σ is 0 ± 0.
  /// @param y  one value per row; NaN: both effects in which it would be are not known.
  std::vector<ElementaryEffects> effects(std::span<const double> y, double confidence) const;

  long n_trajectories() const;

 private:
  struct Move {
    std::uint32_t parameter = 0;
    double direction = 0;  ///< 1 or −1.
  };
  std::size_t n_parameters_ = 0;
  double step_ = 0;
  std::vector<Move> moves_;  ///< trajectory by trajectory.
};
inline constexpr long kFewestTrajectories = 30;
inline constexpr long kFewestForDeviation = 50;

/// A design, or why the rows are none.
struct MorrisDesign::Made {
  std::optional<MorrisDesign> design;
  std::string refusal;  ///< "" where there is a design.
};

}  // namespace faultsweep
