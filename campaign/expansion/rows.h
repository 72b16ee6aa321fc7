#pragma once

#include <vector>

#include "campaign/spec/spec.h"

/// Inside of the module: the rows of a design, numbered, made one at a time.
namespace faultsweep {

/// A choice per parameter of a group; -1 = the base value.
using Row = std::vector<int>;

/// How many rows the design has; at most kMaximumCases, which the spec's reader has seen to.
long count_rows(const Group& group);
/// Row number i, 0 <= i < count_rows. Grid: the last parameter varies fastest.
void row_at(const Group& group, long i, Row& row);

}  // namespace faultsweep
