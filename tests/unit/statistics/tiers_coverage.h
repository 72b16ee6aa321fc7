#pragma once

namespace faultsweep::testing {

/// Tables of means, probabilities and quantiles from two tiers: a part of coverage_study.
void study_tiers(int repeats);

}  // namespace faultsweep::testing
