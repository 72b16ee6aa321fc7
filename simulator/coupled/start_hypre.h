#pragma once

namespace faultsim {

/// Starts MPI (if nobody has) and hypre at the first call; both end with the process. Called by
/// what needs it: commands that never come here never touch MPI.
void start_hypre();

}  // namespace faultsim
