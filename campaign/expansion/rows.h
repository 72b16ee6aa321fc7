#pragma once

#include <vector>

#include "campaign/spec/spec.h"

/// Inside of the module: the rows of a design, numbered, made one at a time.
namespace faultsweep {

/// A value per parameter of a group, numbered as in Parameter; -1 = the base value.
using Row = std::vector<int>;

/// How many rows the group has; at most kMaximumCases, which the spec's reader has seen to.
/// @pre sampled designs are drawn (draw_sampled_rows).
long count_rows(const Group& group);
/// Row number i, 0 <= i < count_rows. Grid: the last parameter varies fastest; nested designs: the
/// rows of the last one.
void row_at(const Group& group, long i, Row& row);

/// Draws the values of ranges and makes the rows of the group's sampled designs. The same design
/// and seed give the same bits, whatever else the campaign has.
///
/// - monte-carlo: row i is sample first + i; samples are independent and uniform.
/// - latin-hypercube: row i is sample i; of n samples each lies in another n-th part of every range
///   (McKay, Beckman & Conover 1979).
/// - sobol: per base sample the rows A, AB_1 .. AB_D, with second_order also BA_1 .. BA_D, then B;
///   AB_j is A with parameter j of B (Saltelli et al. 2010), from a digitally shifted Sobol'
///   sequence in 2 D dimensions; listed values from a Latin hypercube.
/// - morris: trajectories of D + 1 rows on `levels` positions (0, 1/(p-1), .. 1 of a range); one
///   parameter per row moves by p/2 positions, up or down (Morris 1991).
///
/// Values that are listed are levels of equal probability: the j-th of L belongs to the j-th L-th
/// part of the unit interval (morris: of the positions).
void draw_sampled_rows(Group& group);

}  // namespace faultsweep
