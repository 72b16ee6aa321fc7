#pragma once

#include <string>
#include <vector>

#include "campaign/spec/spec.h"

/// Inside of the module: the rows of a design, numbered, made one at a time.
namespace faultsweep {

/// A choice per parameter of a group; -1 = the base value.
using Row = std::vector<int>;

/// How many rows the design has; a long double, because 10^30 must be counted to be refused.
long double count_rows(const Group& group);
/// "100 (offset) x 25 (friction_angle)", for messages.
std::string describe_count(const Group& group);
/// Row number i, 0 <= i < count_rows. Grid: the last parameter varies fastest.
void row_at(const Group& group, long i, Row& row);

}  // namespace faultsweep
