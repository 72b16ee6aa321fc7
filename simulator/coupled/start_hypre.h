#pragma once

namespace faultsim {

/// Starts MPI (if nobody has) and hypre at the first call; both end with the process. Called by
/// what needs it: commands that never come here never touch MPI.
void start_hypre();
/// Throws InputError under mpirun with several ranks: matrices are not distributed so far, and each
/// would do the same work and write the same files. Starts MPI.
void require_one_rank();

}  // namespace faultsim
