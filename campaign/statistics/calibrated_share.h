#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "campaign/statistics/cross_fit.h"
#include "campaign/statistics/predicted_share.h"

namespace faultsweep {

/// What is known of a property of a member.
enum class Flag : char {
  no,
  undecided_no,  ///< open, but it came out as no.
  undecided_yes,
  yes,
};

/// P of a property at an expensive model, known of the first n of N members of a random sample,
/// with features of all N at a cheap one: its margins, extents and flags. The predictions of
/// PredictedShare are logistic regressions on the features (cross_fit.h).
struct CalibratedShare {
  /// Undecided flags as they came out.
  PredictedShare as_computed;
  /// As if none of the undecided had the property, and as if all had. Each has predictions of its
  /// own, so that the bounds hold whichever way the undecided are.
  PredictedShare least, most;
  std::size_t n_undecided = 0;

  /// The value as computed; bounds from the lower one of `least` to the upper one of `most`.
  Estimate estimate(double confidence) const;
  /// What the n flags say alone, with bounds in the same way.
  Estimate direct(double confidence) const;
  /// Half the width that the number of members makes: of what was computed.
  double by_number(double confidence) const;
  /// Half the distance between the values of `least` and `most`.
  double by_undecided(double confidence) const;
};

/// @pre n ≥ kFolds, N ≥ n. Flags at the cheap model that are undecided are features like others.
CalibratedShare calibrated_share(std::span<const Flag> flags, const StandardFeatures& features);

}  // namespace faultsweep
