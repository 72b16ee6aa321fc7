#pragma once

#include "campaign/spec/spec.h"

/// Inside of the module: rows of Monte Carlo, Latin hypercube, Sobol' and Morris designs, by their
/// seed.
namespace faultsweep {

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
