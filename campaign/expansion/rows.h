#pragma once

#include <vector>

#include "campaign/spec/spec.h"

/// Inside of the module: the rows of a design, numbered, made one at a time.
namespace faultsweep {

/// A value per parameter of a group, numbered as in Parameter; -1 = the base value.
using Row = std::vector<int>;

/// How many rows the group has; at most kMaximumCases, which the spec's reader has seen to.
/// @pre sampled designs are drawn (sampled_rows.h).
long count_rows(const Group& group);
/// Row number i, 0 <= i < count_rows. Grid: the last parameter varies fastest; nested designs: the
/// rows of the last one.
void row_at(const Group& group, long i, Row& row);

}  // namespace faultsweep
