#pragma once

namespace faultsim {

/// Makes SIGINT and SIGTERM set a flag instead of ending the process. A second SIGINT ends it.
void catch_interrupts();
/// True once a signal came. Checked per load step and per case.
bool interrupted();
/// Throws Interrupted("stopped by signal while DOING") if interrupted().
void throw_if_interrupted(const char* doing);

}  // namespace faultsim
