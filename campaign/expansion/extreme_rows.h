#pragma once

#include <cstddef>
#include <vector>

#include "campaign/expansion/case_values.h"

namespace faultsweep {

/// Up to n choices of a parameter, always with the first, last, smallest and largest.
std::vector<int> sample_choices(const Parameter& parameter, std::size_t n);

/// The rows by which a large design is checked: every combination of extreme values of its grids
/// (up to 128), and 32 rows spread over the design; without those that are excluded.
/// @param matters  per parameter: false = its values are not looked at.
std::vector<Row> extreme_rows(const Group& group, const CaseValues& values,
                              const std::vector<bool>& matters);

}  // namespace faultsweep
