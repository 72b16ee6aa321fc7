#pragma once

namespace faultsim {

/// SIGINT, SIGTERM and SIGHUP end the process with ExitCode::interrupted, at once. A SIGHUP that is
/// ignored (nohup) stays so. A write beyond a file size limit fails (EFBIG), as on a full disk,
/// instead of ending the process by SIGXFSZ. Called once, as a program starts.
void end_on_signals();
/// From now on the first of these signals sets a flag; the second ends the process at once,
/// whatever it is doing.
void catch_interrupts();
/// True once a signal came. Checked per load step and per case.
bool interrupted();
/// Throws Interrupted("stopped by signal while DOING") if interrupted().
void throw_if_interrupted(const char* doing);

}  // namespace faultsim
