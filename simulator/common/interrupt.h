#pragma once

#include "simulator/common/exit_code.h"
#include "simulator/common/run_context.h"

/// Signals, for programs: a library leaves them to whoever uses it.
namespace faultsim {

/// SIGINT, SIGTERM and SIGHUP end the process with that code, at once. A SIGHUP that is ignored
/// (nohup) stays so. A write beyond a file size limit fails (EFBIG), as on a full disk, instead of
/// ending the process by SIGXFSZ. Called as a program starts, and again where such an end is what
/// was asked for.
void end_on_signals(ExitCode code = ExitCode::interrupted);
/// From now on the first of these signals asks work that was given the token to stop; the second
/// ends the process at once, whatever it is doing.
StopToken stop_on_signals();

}  // namespace faultsim
