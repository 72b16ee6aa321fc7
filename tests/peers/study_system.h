#pragma once

#include <petscmat.h>

#include <string>
#include <vector>

namespace faultsim {

/// What `faultsim solver-study --export` wrote, in PETSc's hands: J = [[A, B], [C, 0]] scaled as
/// our GMRES sees it, six near-null vectors of A and two right-hand sides. PETSc's objects live
/// until PetscFinalize.
struct StudySystem {
  Mat leading = nullptr, coupling = nullptr, constraint = nullptr;
  std::vector<Vec> near_null;
  Vec random = nullptr, physical = nullptr;
};

/// Ends the program with PETSc's message where a file is missing or not what it should be.
StudySystem load_study(const std::string& folder);

/// Processor seconds of this process.
double processor_seconds();

/// What a peer took for both right-hand sides.
struct PeerRow {
  struct Counts {
    int to_1e6 = -1, to_1e8 = -1;  ///< iterations; −1 = not within the limit.
  };
  Counts random, physical;
  double setup_seconds = 0, solve_seconds = 0;  ///< of the processor; of the random one to 1e-8.
  double true_residual = 0;                     ///< the larger |b − J x| / |b|, computed.
  std::string failure;                          ///< empty = none.
};

/// A KSP as PETSc's options say, on J as a nest of its blocks; fields are named u and l.
PeerRow petsc_row(const StudySystem& system, int max_iterations);

/// MUMPS' LDLᵀ of J, ordered by METIS: the graph of nodes, the multipliers of a fault node and both
/// of its copies taken as one. Takes the matrices away. A right-hand side counts one iteration.
/// @param memory_limit  MB that MUMPS may say after its analysis that it wants.
PeerRow mumps_row(StudySystem& system, double memory_limit);

}  // namespace faultsim
