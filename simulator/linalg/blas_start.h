#pragma once

/// What has to happen to OpenBLAS before it computes. As it is loaded it starts a thread per core,
/// each with a work buffer of 128 MB, and its first call takes one more. Where a limit leaves no
/// room for a buffer it (0.3.21) asks again for ever: the process hangs.
namespace faultsim {

/// To be called first in main: one thread (bits depend on how many OpenBLAS has, so it is not a
/// choice of the user's; supernodal_factor.h has threads of its own) and the widest kernel
/// (blas_kernel.h). Starts the program anew, at most once, where OpenBLAS has begun otherwise;
/// children inherit the variables that say so.
/// @throws ResourceError as choose_blas_kernel().
void start_blas(char** argv);

/// Takes the work buffer of the one thread, once per process, so that no later call needs another:
/// to be called before anything computes, and before the process limits its own memory; before
/// threads are started, so that what it asks for does not depend on what they have taken already.
/// @throws ResourceError where the limits of the process (ulimit -v, ulimit -d) or of the machine
///         leave too little for the buffer and a small scene; it names the least limit.
void take_blas_buffer();

}  // namespace faultsim
