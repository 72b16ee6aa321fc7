#pragma once

#include "simulator/common/run_context.h"

/// Signals, for programs: a library leaves them to whoever uses it.
namespace faultsim {

/// SIGINT, SIGTERM and SIGHUP end the process with ExitCode::interrupted, at once. A SIGHUP that is
/// ignored (nohup) stays so. A write beyond a file size limit fails (EFBIG), as on a full disk,
/// instead of ending the process by SIGXFSZ. Called once, as a program starts.
void end_on_signals();
/// From now on the first of these signals asks work that was given the token to stop; the second
/// ends the process at once, whatever it is doing.
StopToken stop_on_signals();

}  // namespace faultsim
