#pragma once

#include "simulator/result/result.h"

namespace faultsim {

/// How far a case on an interpolated operator is off the same on the exact one.
struct CaseErrors {
  double chi_bar = 0;       ///< largest |Δχ̄| of a fault at a load step; infinite where one case
                            ///< ends and the other goes on.
  double largest_slip = 0;  ///< largest |Δ| of a fault's largest slip at a load step, over the
                            ///< largest slip of the exact case; below 1 mm over 1 mm.
  int flags_that_differ = 0;  ///< of those that say whether a fault slides in a stage, where both
                              ///< say so for certain, and of outcomes.

  void take_larger(const CaseErrors& other);  ///< flags are added.
  /// χ̄ within the tolerance and slips within ten times it. Flags differ only where χ̄ is next to
  /// its threshold, and are counted.
  bool within(double tolerance) const;
  bool are_known() const;  ///< both are finite.
};

/// Over the load steps that both have.
CaseErrors case_errors(const CaseResult& found, const CaseResult& exact);

}  // namespace faultsim
